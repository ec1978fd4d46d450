#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/base/number_text.hpp"
#include "core/base/quoted.hpp"
#include "core/scene/body_groups.hpp"
#include "core/scene/response_parts.hpp"
#include "core/trust/bent_beams.hpp"
#include "core/trust/check_list.hpp"
#include "core/trust/coarse_runs.hpp"
#include "core/trust/round_off.hpp"

namespace pleuel {

namespace {

/// Changes that are as good as none, and those from which on numbers are those of another
/// mechanism, relative. Between them what is missing is a property of the theory that is used.
constexpr double tolerable_change = 0.01, alarming_change = 0.1;
/// So many beams are told apart, each of which is simulated alone.
constexpr std::size_t most_told_apart = 8;
/// Beams that make less of a change, or have less of an indicator than others, are not named.
constexpr double told_part = 0.1;

using Names = std::vector<std::string>;

BeamBody& beam_of(ProblemFile& problem, const std::string& name) {
  return std::get<BeamBody>(find_named(problem.scene.bodies, name)->shape);
}

const BeamBody& beam_of(const ProblemFile& problem, const std::string& name) {
  return std::get<BeamBody>(find_named(problem.scene.bodies, name)->shape);
}

/// One thing that beams may leave out.
struct Variant {
  std::string_view name;
  Cause cause;
  double missing;  ///< of what it changes: all that is missing
  std::vector<ConcernedBeam> (*find)(const TrustedRun&);
  bool is_by_beam;  ///< whether one beam can have it without the others
  void (*put_in)(ProblemFile&, const std::string& beam);
  /// What else says whether it counts, where not all responses are there with it; null: nothing.
  std::vector<Finding> (*untold)(const TrustedRun&, const Names&, const std::string& why);
  std::string_view one, several;  ///< "is stubby: shear, which it leaves out,"
  /// @param change  the largest that is told, relative
  std::string (*advice)(const ProblemFile&, const Names& beams, double change);
};

/// Whether the sections of a beam say how stiff in shear they are.
bool is_shear_known(const BeamBody& beam) {
  return std::ranges::all_of(beam.segments, [](const Segment& segment) {
    const auto* general = std::get_if<GeneralSection>(&segment.section);
    return general == nullptr || general->shear_area_y;
  });
}

std::string advice_of_shear(const ProblemFile& problem, const Names& beams, double /*change*/) {
  Names unknown;
  for (const std::string& beam : beams) {
    if (!is_shear_known(beam_of(problem, beam))) unknown.push_back(beam);
  }
  const std::string key =
      beams.size() == 1 ? fmt::format("/scene/bodies/{}/shear", beams.front()) : "their \"shear\"";
  if (unknown.empty()) return fmt::format("set {} to true", key);
  return fmt::format(
      "set {} to true, and give the section of {} \"shear_area_y\" and "
      "\"shear_area_z\" (those of a rectangle are taken here)",
      key, quoted(unknown));
}

/// Errors fall as the square of the number of frames.
std::string advice_of_frames(const ProblemFile& problem, const Names& beams, double change) {
  constexpr double reserve = 1.1, most = 10.0;
  const double factor = reserve * std::sqrt(std::min(change, most) / tolerable_change);
  Names frames;
  for (const std::string& beam : beams) {
    frames.push_back(fmt::format("/scene/bodies/{}/frames to {:.0f}", beam,
                                 std::ceil(beam_of(problem, beam).frames * factor)));
  }
  return fmt::format("set {}", fmt::join(frames, ", "));
}

/// All elastic beams, where the file switches off what axial forces come from.
std::vector<ConcernedBeam> find_unstretched(const TrustedRun& run) {
  std::vector<ConcernedBeam> found;
  if (run.problem.effects.axial_elasticity != EffectChoice::off) return found;
  for (const Body& body : run.problem.scene.bodies) {
    const bool is_beam = std::holds_alternative<BeamBody>(body.shape);
    if (is_beam && run.analysis.model.parts(body.name).front()->is_elastic) {
      found.push_back({body.name, 1.0});
    }
  }
  return found;
}

std::string advice_of_elements(const ProblemFile&, const Names& beams, double) {
  return fmt::format("divide {} by short \"segments\" where it is held or loaded", quoted(beams));
}

std::string advice_of_stretch(const ProblemFile&, const Names&, double) {
  return "set /effects/axial_elasticity to auto";
}

constexpr Variant variants[] = {
    {"shear", Cause::left_out, 1.0, find_slenderness, true,
     [](ProblemFile& problem, const std::string& beam) { beam_of(problem, beam).has_shear = true; },
     nullptr, "is stubby: shear, which it leaves out,", "are stubby: shear, which they leave out,",
     advice_of_shear},
    {"more_frames", Cause::not_modelled, 4.0 / 3.0, find_far_bending, true,
     [](ProblemFile& problem, const std::string& beam) { beam_of(problem, beam).frames *= 2; },
     check_untold_bending, "bends too far for linear elasticity in its frame: more frames",
     "bend too far for linear elasticity in their frames: more frames", advice_of_frames},
    {"more_elements", Cause::not_converged, 1.0, find_taut, true,
     [](ProblemFile& problem, const std::string& beam) {
       for (Segment& segment : beam_of(problem, beam).segments) segment.elements *= 4;
     },
     nullptr, "is taut and bends within less than an element: shorter ones",
     "are taut and bend within less than an element: shorter ones", advice_of_elements},
    {"axial_elasticity", Cause::left_out, 1.0, find_unstretched, false,
     [](ProblemFile& problem, const std::string&) {
       problem.effects.axial_elasticity = EffectChoice::on;
     },
     nullptr, "cannot be stretched: axial elasticity, which it leaves out with N/A,",
     "cannot be stretched: axial elasticity, which they leave out with N/A,", advice_of_stretch},
};

/// One variant of a run.
class VariantRun {
 public:
  VariantRun(const TrustedRun& run, const Variant& variant, const std::vector<ConcernedBeam>& beams)
      : run_(run), variant_(variant), groups_(run.problem.scene) {
    for (const auto& [name, indicator] : beams) {
      beams_.push_back(name);
      indicators_.push_back(indicator);
    }
  }

  void find(LeftOut& found) {
    std::unique_ptr<Analysis> changed;
    ProblemFile problem;
    try {
      changed = analyze_variant(run_, [&](ProblemFile& variant) {
        for (const std::string& beam : beams_) variant_.put_in(variant, beam);
        problem = variant;
      });
    } catch (const SimulationError& error) {
      found.findings.push_back(failed(error.what()));
      return;
    } catch (const InputError& error) {  // of what cannot be asked of it
      for (Finding& finding : untold(error.what())) found.findings.push_back(std::move(finding));
      return;
    }
    measure({problem, run_.x, *changed, run_.monitors});
    found.changes.push_back({std::string(variant_.name), missing_values()});
    // One advice at a time: what helps against the large changes helps against the others.
    if (!add_finding(true, found.findings)) add_finding(false, found.findings);
  }

 private:
  /// What is missing of each response, nothing of round-off; not a number where it is unknown.
  Eigen::VectorXd missing_values() const {
    Eigen::VectorXd missing = variant_.missing * differences_;
    for (Eigen::Index i = 0; i < missing.size(); ++i) {
      if (changes_[i].of_value == 0.0 && std::isfinite(missing(i))) missing(i) = 0.0;
    }
    return missing;
  }

  Finding failed(const std::string& why) const {
    return {fmt::format("{} {} might change anything: this design cannot be simulated then: {}",
                        quoted(beams_), words(beams_), why),
            true,
            {},
            {},
            variant_.cause};
  }

  std::vector<Finding> untold(const std::string& why) const {
    if (variant_.untold == nullptr) return {failed(why)};
    std::vector<Finding> findings = variant_.untold(run_, beams_, why);
    for (Finding& finding : findings) finding.cause = variant_.cause;
    return findings;
  }

  std::string_view words(const Names& beams) const {
    return beams.size() == 1 ? variant_.one : variant_.several;
  }

  void measure(const TrustedRun& changed) {
    changes_ = changes_of(changed.analysis);
    differences_ = differences_of(changed.analysis);
    std::vector<std::size_t> told;
    for (std::size_t i = 0; i < changes_.size(); ++i) {
      if (changes_[i].of_value > tolerable_change) told.push_back(i);
    }
    if (told.empty()) return;
    const std::vector<bool> was_nothing = find_round_off(run_);
    if (std::ranges::any_of(told, [&](std::size_t i) { return was_nothing[i]; })) {
      const std::vector<bool> is_nothing = find_round_off(changed);
      std::erase_if(told, [&](std::size_t i) {
        if (!was_nothing[i] || !is_nothing[i]) return false;
        changes_[i] = {};
        return true;
      });
    }
    if (!told.empty()) share_out();
  }

  /// Which beams the changes are due to: by a simulation with each alone, until one makes all of them;
  /// to first order the last makes what the others leave. Of very many those whose own indicator is not
  /// far below the largest.
  void share_out() {
    const std::size_t count = beams_.size();
    by_beam_.assign(count, differences_);
    if (count == 1 || !variant_.is_by_beam) return;
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(differences_.size());
    if (count > most_told_apart) {
      for (std::size_t k = 0; k < count; ++k) {
        if (indicators_[k] <= told_part * indicators_.front()) by_beam_[k] = none;
      }
      return;
    }
    for (std::size_t k = 0; k + 1 < count; ++k) {
      try {
        by_beam_[k] = differences_of(*analyze_variant(
            run_, [&](ProblemFile& variant) { variant_.put_in(variant, beams_[k]); }));
      } catch (const SimulationError&) {  // this one has a part in all
        continue;
      }
      by_beam_.back() -= by_beam_[k];
      if (!makes_all(by_beam_[k])) continue;
      for (std::size_t other = 0; other < count; ++other) {
        if (other != k) by_beam_[other] = none;
      }
      return;
    }
  }

  bool makes_all(const Eigen::VectorXd& alone) const {
    for (std::size_t i = 0; i < changes_.size(); ++i) {
      if (changes_[i].of_value <= tolerable_change) continue;
      const double by_others = std::abs(differences_(i) - alone(i));
      if (by_others > told_part * std::abs(differences_(i))) return false;
    }
    return true;
  }

  Eigen::VectorXd differences_of(const Analysis& changed) const {
    return values_of(changed) - values_of(basis_of_variants(run_));
  }

  /// What is missing of each response.
  std::vector<ResponseChange> changes_of(const Analysis& changed) const {
    std::vector<ResponseChange> changes =
        response_changes(run_.problem, changed, basis_of_variants(run_));
    for (ResponseChange& change : changes) {
      change.of_value *= variant_.missing;
      change.beside_limits *= variant_.missing;
    }
    return changes;
  }

  /// Of the responses whose change is alarming, which is serious where one of them is asked for, or of
  /// the others that are worth a word.
  /// @returns whether there are any
  bool add_finding(bool alarming, std::vector<Finding>& findings) const {
    std::vector<std::size_t> asked = asked_responses(run_.problem);
    std::ranges::copy(asked_parts(run_.problem), std::back_inserter(asked));
    Names names, changed;
    std::vector<bool> has_part(beams_.size(), false);
    double largest = 0.0;
    bool is_serious = false;
    for (std::size_t i = 0; i < changes_.size(); ++i) {
      const double change = changes_[i].of_value;
      const bool is_alarming = changes_[i].beside_limits > alarming_change;
      if (change <= tolerable_change || is_alarming != alarming) continue;
      is_serious = is_serious || (alarming && std::ranges::find(asked, i) != asked.end());
      const ResponseSettings& response = run_.problem.responses[i];
      names.push_back(response.name);
      changed.push_back(fmt::format("\"{}\" by {}", response.name, rough_percent(change)));
      largest = std::max(largest, change);
      for (std::size_t k = 0; k < beams_.size(); ++k) {
        const bool is_told = std::abs(by_beam_[k](i)) > told_part * std::abs(differences_(i));
        if (is_told && depends_on(response, beams_[k])) has_part[k] = true;
      }
    }
    if (names.empty()) return false;
    Names beams;
    for (std::size_t k = 0; k < beams_.size(); ++k) {
      if (has_part[k]) beams.push_back(beams_[k]);
    }
    if (beams.empty()) beams = beams_;  // they do it together
    findings.push_back({fmt::format("{} {} would change {} (of what {} then). {}: {}.",
                                    quoted(beams), words(beams), fmt::join(changed, ", "),
                                    names.size() == 1 ? "it is" : "they are",
                                    is_serious ? "Do not trust that" : "Where that matters",
                                    variant_.advice(run_.problem, beams, largest)),
                        is_serious,
                        names,
                        {},
                        variant_.cause});
    return true;
  }

  /// Whether a beam is tied to what a response is about.
  bool depends_on(const ResponseSettings& response, const std::string& beam) const {
    Names about = bodies_about(response, run_.problem.scene);
    std::erase(about, ground_name);
    return about.empty() || std::ranges::any_of(about, [&](const std::string& other) {
             return groups_.of(other) == groups_.of(beam);
           });
  }

  const TrustedRun& run_;
  const Variant& variant_;
  Names beams_;                     ///< that get what they leave out
  std::vector<double> indicators_;  ///< of each
  BodyGroups groups_;
  std::vector<ResponseChange> changes_;   ///< one a response
  Eigen::VectorXd differences_;           ///< of the values [SI]
  std::vector<Eigen::VectorXd> by_beam_;  ///< the same by each beam alone
};

}  // namespace

LeftOut compare_variants(const TrustedRun& run) {
  LeftOut found;
  if (run.problem.responses.empty()) return found;
  for (const Variant& variant : variants) {
    const std::vector<ConcernedBeam> beams = variant.find(run);
    if (!beams.empty()) VariantRun(run, variant, beams).find(found);
  }
  return found;
}

}  // namespace pleuel
