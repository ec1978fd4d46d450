#include "cli/ranks.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include "cli/input/fingerprint.hpp"
#include "cli/interruption.hpp"
#include "core/base/error.hpp"
#include "optimization/design/multi_start.hpp"
#include "optimization/design/size_lists.hpp"
#include "studies/pareto.hpp"
#include "studies/uncertainty.hpp"

namespace pleuel {

namespace {

std::string machine_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "?";
}

std::vector<int> usable_processors() {
  cpu_set_t usable;
  std::vector<int> processors;
  if (::sched_getaffinity(0, sizeof usable, &usable) != 0) return processors;
  for (int i = 0; i < CPU_SETSIZE; ++i) {
    if (CPU_ISSET(i, &usable)) processors.push_back(i);
  }
  return processors;
}

/// All work that other ranks can do.
WorkMakers work_makers() {
  return {{search_work_name, make_search_work},
          {trial_work_name, make_trial_work},
          {point_work_name, make_point_work},
          {sample_work_name, make_sample_work}};
}

RankDescription describe_rank() {
  return {machine_name(), program_fingerprint(), usable_processors()};
}

/// Processors of each rank, at least one: where several may use the same ones each has its part.
std::vector<int> processors_of(const std::vector<RankDescription>& ranks) {
  std::map<std::pair<std::string, int>, int> users;  // of each processor
  for (const RankDescription& rank : ranks) {
    for (const int processor : rank.processors) ++users[{rank.machine, processor}];
  }
  std::vector<int> counts;
  for (const RankDescription& rank : ranks) {
    double sum = 0.0;
    for (const int processor : rank.processors) sum += 1.0 / users[{rank.machine, processor}];
    constexpr double rounding = 1e-6;
    counts.push_back(std::max(1, static_cast<int>(sum + rounding)));
  }
  return counts;
}

}  // namespace

Ranks::Ranks(std::vector<Channel> links) : links_(std::move(links)), ranks_{describe_rank()} {
  for (Channel& link : links_) {
    Frame frame;
    if (!link.receive(frame)) {
      throw InputError(fmt::format("rank {} of the job was lost at its start", ranks_.size()));
    }
    ranks_.push_back(unpacked<RankDescription>(frame.content));
    if (ranks_.back().program != ranks_.front().program) {
      throw InputError(
          fmt::format("rank {} on {} runs another program than rank 0 on {}: all "
                      "machines must run the same build",
                      ranks_.size() - 1, ranks_.back().machine, ranks_.front().machine));
    }
  }
  processors_ = processors_of(ranks_);
}

std::vector<RankPlace> Ranks::take_places(int jobs) {
  std::vector<RankPlace> places;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    places.emplace_back(std::move(links_[i]),
                        fmt::format("rank {} on {}", i + 1, ranks_[i + 1].machine),
                        jobs > 0 ? jobs : processors_[i + 1]);
  }
  return places;
}

std::string Ranks::text() const {
  std::set<std::string> machines;
  for (const RankDescription& rank : ranks_) machines.insert(rank.machine);
  return fmt::format("{} ranks on {} machine{}", ranks_.size(), machines.size(),
                     machines.size() == 1 ? "" : "s");
}

void serve_rank_zero(Channel link) {
  const Interruption interruption;  // of the processes that will be made
  if (!link.send({Frame::Kind::message, packed(describe_rank())})) return;
  serve_tasks(link, work_makers());
}

}  // namespace pleuel
