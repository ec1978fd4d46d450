#include "core/effects/body_equations.hpp"

namespace pleuel {

void set_body_motion(const BodyFrame& frame, const Eigen::Vector3d& gravity,
                     const Coordinates<double>& q, const Coordinates<double>& v,
                     const Coordinates<double>& a, BodyMotion& motion) {
  const Eigen::Index m = frame.size();
  motion.q = q.tail(q.size() - m);
  motion.v = v.tail(q.size() - m);
  motion.a = a.tail(q.size() - m);
  motion.frame = frame_motion<double>(frame, q.head(m), v.head(m), a.head(m));
  const Eigen::Matrix3d omega = skew<double>(motion.frame.omega);
  motion.a0 = motion.frame.A.transpose() * (motion.frame.r_ddot - gravity);
  motion.X = skew<double>(motion.frame.alpha) + omega * omega;
  motion.Y = 2.0 * omega;
}

void declare_body_entries(const BodyFrame& frame, const ElasticPattern& pattern,
                          EntryList& entries) {
  const int m = frame.size(), n = pattern.size, rigid = frame.offset, elastic = rigid + m;
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < m; ++j) entries.emplace_back(rigid + i, rigid + j);
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) entries.emplace_back(rigid + j, elastic + i);
    for (int j = 0; j < m; ++j) entries.emplace_back(elastic + i, rigid + j);
  }
  for (int row = 0; row < n; ++row) {
    for (int i = pattern.row_start[row]; i < pattern.row_start[row + 1]; ++i) {
      entries.emplace_back(elastic + row, elastic + pattern.column[i]);
    }
  }
}

}  // namespace pleuel
