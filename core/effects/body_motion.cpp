#include "core/effects/body_motion.hpp"

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

}  // namespace pleuel
