#pragma once

#include <vector>

#include "core/jobs/rank_place.hpp"

namespace pleuel {

/// What a rank says of itself.
struct RankDescription {
  std::string machine;
  std::string program;          ///< fingerprint: what goes between ranks is of this program only
  std::vector<int> processors;  ///< of its machine that it may use
};

/// The other ranks of a job, as rank 0 sees them.
class Ranks {
 public:
  /// Waits until all have said who they are.
  /// @throws InputError if they run another program
  explicit Ranks(std::vector<Channel> links);

  /// Of rank 0 itself.
  int processors_here() const { return processors_.front(); }

  /// @param jobs  workers of each; 0: as many as each has processors
  std::vector<RankPlace> take_places(int jobs);

  /// "3 ranks on 2 machines"
  std::string text() const;

 private:
  std::vector<Channel> links_;
  std::vector<RankDescription> ranks_;  ///< rank 0 first
  std::vector<int> processors_;
};

/// What another rank does: tasks of rank 0 until that ends.
void serve_rank_zero(Channel link);

}  // namespace pleuel
