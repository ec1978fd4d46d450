#pragma once

#include <optional>

#include "core/jobs/worker.hpp"

namespace pleuel {

/// The place of a process among those that mpirun or srun has started together.
struct RankOfJob {
  int rank = 0;
  int ranks = 1;
};

/// From the environment. None of a process that was started otherwise, or alone.
std::optional<RankOfJob> rank_of_job();

/// Splits this process in two: it becomes the program beside this one that speaks MPI (mpi/relay.hpp)
/// and ends as its child does; the child goes on behind this call, with nothing of MPI in its
/// environment. MPI and forked processes do not go together: Open MPI warns of it, and the
/// sequential MUMPS that Ipopt brings has functions with the names of MPI.
/// @returns links to the other ranks in their order; of another rank than 0 the one to rank 0
/// @throws InputError if there is no such program, on rank 0; on others it just ends
std::vector<Channel> join_job(const RankOfJob& place);

}  // namespace pleuel
