#include "core/effects/body_equations.hpp"

namespace pleuel {

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
