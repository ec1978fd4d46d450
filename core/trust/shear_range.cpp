#include "core/trust/shear_range.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/base/parallel.hpp"
#include "core/scene/body_groups.hpp"
#include "core/trust/response_changes.hpp"
#include "core/trust/round_off.hpp"
#include "core/trust/stubby_beams.hpp"
#include "core/trust/variants.hpp"

namespace pleuel {

namespace {

/// Changes that are as good as none, relative.
constexpr double tolerable_shear = 0.01;
/// From here on numbers are those of another beam. Below, that shear is missing is a property of
/// the theory that is used, as good as it is for most machines.
constexpr double alarming = 0.1;
/// So many beams are told apart, each of which is simulated with shear alone.
constexpr std::size_t most_told_apart = 8;
/// Beams that make less of a change, or have less shear than others, are not named.
constexpr double told_part = 0.1;

class ShearDoubts {
 public:
  ShearDoubts(const TrustedRun& run, const std::vector<StubbyBeam>& stubby)
      : run_(run), groups_(run.problem.scene) {
    for (const auto& [name, share] : stubby) {
      beams_.push_back(name);
      shares_.push_back(share);
    }
  }

  std::vector<Doubt> find() {
    try {
      sheared_ = with_shear(beams_);
    } catch (const SimulationError& error) {
      return {{fmt::format("with shear, which {} {} out, this design cannot be simulated: {}",
                           quoted(beams_), beams_.size() == 1 ? "leaves" : "leave", error.what()),
               true}};
    }
    measure();
    std::vector<Doubt> doubts;
    for (const bool is_serious : {true, false}) add_doubt(is_serious, doubts);
    return doubts;
  }

 private:
  /// @throws SimulationError
  std::unique_ptr<Analysis> with_shear(const std::vector<std::string>& beams) const {
    ProblemFile problem = problem_of_variants(run_);
    for (Body& body : problem.scene.bodies) {
      if (std::find(beams.begin(), beams.end(), body.name) == beams.end()) continue;
      std::get<BeamBody>(body.shape).has_shear = true;
    }
    return analyze_variant(run_, problem);
  }

  void measure() {
    changes_ = changes_of(*sheared_);
    if (!is_any_above(tolerable_shear, &ResponseChange::of_value)) return;
    const std::vector<bool> is_nothing = find_round_off(run_);
    for (std::size_t i = 0; i < changes_.size(); ++i) {
      if (is_nothing[i]) changes_[i] = {};
    }
    share_out();
  }

  bool is_any_above(double limit, double ResponseChange::*kind) const {
    return std::any_of(changes_.begin(), changes_.end(),
                       [&](const ResponseChange& change) { return change.*kind > limit; });
  }

  /// Which beams the changes are due to: of alarming ones by a simulation with each alone; else
  /// those whose own share of shear is not far below the largest.
  void share_out() {
    by_beam_.assign(beams_.size(), changes_);
    for (std::size_t k = 0; k < beams_.size(); ++k) {
      if (shares_[k] <= told_part * shares_.front()) by_beam_[k].assign(changes_.size(), {});
    }
    const bool is_alarming = is_any_above(alarming, &ResponseChange::beside_limits);
    if (!is_alarming || beams_.size() == 1 || beams_.size() > most_told_apart) return;
    for_each_in_parallel(int_size(beams_), available_threads(), [&](int i) {
      try {
        by_beam_[i] = changes_of(*with_shear({beams_[i]}));
      } catch (const SimulationError&) {
        by_beam_[i] = changes_;  // this one has a part in all
      }
    });
  }

  /// What shear changes of each response.
  std::vector<ResponseChange> changes_of(const Analysis& sheared) const {
    return response_changes(run_.problem, sheared, basis_of_variants(run_));
  }

  /// Of the responses whose change is alarming, or of the others that are worth a word.
  void add_doubt(bool is_serious, std::vector<Doubt>& doubts) const {
    std::vector<std::string> names, changed;
    std::vector<bool> has_part(beams_.size(), false);
    for (std::size_t i = 0; i < changes_.size(); ++i) {
      const double change = changes_[i].of_value;
      const bool is_alarming = changes_[i].beside_limits > alarming;
      if (change <= tolerable_shear || is_alarming != is_serious) continue;
      const ResponseSettings& response = run_.problem.responses[i];
      names.push_back(response.name);
      changed.push_back(fmt::format("\"{}\" by {:.2g} %", response.name, 100.0 * change));
      for (std::size_t k = 0; k < beams_.size(); ++k) {
        const bool is_told = by_beam_[k][i].of_value > told_part * change;
        if (is_told && depends_on(response, beams_[k])) has_part[k] = true;
      }
    }
    if (names.empty()) return;
    std::vector<std::string> beams;
    for (std::size_t k = 0; k < beams_.size(); ++k) {
      if (has_part[k]) beams.push_back(beams_[k]);
    }
    if (beams.empty()) beams = beams_;  // they do it together
    const bool is_one = beams.size() == 1;
    doubts.push_back(
        {fmt::format("{} {} stubby: shear, which {}, would change {} (of what {} then). {}: {}.",
                     quoted(beams), is_one ? "is" : "are",
                     is_one ? "it leaves out" : "they leave out", fmt::join(changed, ", "),
                     names.size() == 1 ? "it is" : "they are",
                     is_serious ? "Do not trust that" : "Where that matters", advice(beams)),
         is_serious, names});
  }

  static std::string quoted(const std::vector<std::string>& names) {
    std::vector<std::string> all;
    for (const std::string& name : names) all.push_back(fmt::format("\"{}\"", name));
    return fmt::format("{}", fmt::join(all, ", "));
  }

  std::string advice(const std::vector<std::string>& beams) const {
    std::vector<std::string> unknown;
    for (const std::string& beam : beams) {
      if (!is_known(beam)) unknown.push_back(beam);
    }
    const std::string key = beams.size() == 1 ? fmt::format("/scene/bodies/{}/shear", beams.front())
                                              : "their \"shear\"";
    if (unknown.empty()) return fmt::format("set {} to true", key);
    return fmt::format(
        "set {} to true, and give the section of {} \"shear_area_y\" and "
        "\"shear_area_z\" (those of a rectangle are taken here)",
        key, quoted(unknown));
  }

  /// Whether the sections of a beam say how stiff in shear they are.
  bool is_known(const std::string& beam) const {
    const auto& shape = std::get<BeamBody>(find_named(run_.problem.scene.bodies, beam)->shape);
    return std::all_of(shape.segments.begin(), shape.segments.end(), [](const Segment& segment) {
      const auto* general = std::get_if<GeneralSection>(&segment.section);
      return general == nullptr || general->shear_area_y;
    });
  }

  /// Whether a beam is tied to what a response is about.
  bool depends_on(const ResponseSettings& response, const std::string& beam) const {
    std::vector<std::string> about = response.bodies;
    const Joint* joint = find_named(run_.problem.scene.joints, response.joint);
    if (joint != nullptr) about.insert(about.end(), joint->bodies.begin(), joint->bodies.end());
    std::erase(about, ground_name);
    return about.empty() || std::any_of(about.begin(), about.end(), [&](const std::string& other) {
             return groups_.of(other) == groups_.of(beam);
           });
  }

  const TrustedRun& run_;
  std::vector<std::string> beams_;  ///< that get shear
  std::vector<double> shares_;      ///< of shear, of each
  BodyGroups groups_;
  std::unique_ptr<Analysis> sheared_;
  std::vector<ResponseChange> changes_;               ///< one a response
  std::vector<std::vector<ResponseChange>> by_beam_;  ///< by shear in each alone
};

}  // namespace

std::vector<Doubt> doubt_shear_range(const TrustedRun& run) {
  if (run.problem.responses.empty()) return {};
  const std::vector<StubbyBeam> stubby = find_stubby_beams(run);
  if (stubby.empty()) return {};
  return ShearDoubts(run, stubby).find();
}

}  // namespace pleuel
