#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/model/effect_decisions.hpp"
#include "core/model/elastic_builders.hpp"
#include "core/model/imported_constants.hpp"

namespace pleuel {

namespace {

/// The pattern and the pairs that the constants and all their derivatives need.
struct Arrangement {
  ElasticPattern pattern;
  std::vector<std::pair<int, int>> pairs;
};

class ArrangementFinder {
 public:
  explicit ArrangementFinder(int size) : size_(size), groups_(size) {
    for (std::size_t i = 0; i < groups_.size(); ++i) groups_[i] = {static_cast<int>(i)};
  }

  void add(const BodyConstants& constants) {
    for (const auto* matrix : {&constants.mass_matrix, &constants.stiffness, &constants.damping}) {
      add(*matrix);
    }
    for (std::size_t i = 0; i < moment_pairs.size(); ++i) {
      add(constants.moments[i]);
      has_pair_[i] = has_pair_[i] || constants.moments[i].nonZeros() > 0;
    }
  }

  Arrangement find() const {
    Arrangement arrangement{pattern_of_groups(size_, groups_), {}};
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 3; ++l) {
        for (std::size_t i = 0; i < moment_pairs.size(); ++i) {
          const auto [first, second] = moment_pairs[i];
          const bool is_it = (first == k && second == l) || (first == l && second == k);
          if (is_it && has_pair_[i]) arrangement.pairs.emplace_back(k, l);
        }
      }
    }
    return arrangement;
  }

 private:
  void add(const SparseMatrix& matrix) {
    for (int row = 0; row < matrix.outerSize(); ++row) {
      for (SparseMatrix::InnerIterator entry(matrix, row); entry; ++entry) {
        groups_.push_back({row, static_cast<int>(entry.col())});
      }
    }
  }

  int size_;
  std::vector<std::vector<int>> groups_;
  std::array<bool, 6> has_pair_{};
};

Eigen::VectorXd entries_of(const SparseMatrix& matrix, const ElasticPattern& pattern) {
  Eigen::VectorXd entries = Eigen::VectorXd::Zero(pattern.nonzeros());
  for (int row = 0; row < matrix.outerSize(); ++row) {
    for (SparseMatrix::InnerIterator entry(matrix, row); entry; ++entry) {
      entries(pattern.find(row, static_cast<int>(entry.col()))) = entry.value();
    }
  }
  return entries;
}

Eigen::VectorXd moment_entries(const BodyConstants& constants, const std::pair<int, int>& pair,
                               const ElasticPattern& pattern) {
  const auto [k, l] = pair;
  const auto index = [](int a, int b) {
    const auto found = std::ranges::find(moment_pairs, std::pair(a, b));
    return static_cast<std::size_t>(found - moment_pairs.begin());
  };
  const std::size_t given = index(k, l);
  if (given < moment_pairs.size()) return entries_of(constants.moments[given], pattern);
  return entries_of(SparseMatrix(constants.moments[index(l, k)].transpose()), pattern);
}

Invariants<double> invariants_of(const BodyConstants& constants, const Arrangement& arrangement) {
  const ElasticPattern& pattern = arrangement.pattern;
  Invariants<double> invariants;
  invariants.pattern = pattern;
  invariants.pairs = arrangement.pairs;
  invariants.mass = constants.mass;
  invariants.first_moment = constants.first_moment;
  invariants.second_moment = constants.second_moment;
  invariants.shape = Eigen::MatrixXd(constants.shape);
  invariants.mixed = Eigen::MatrixXd(constants.mixed);
  invariants.mass_matrix = entries_of(constants.mass_matrix, pattern);
  invariants.stiffness = entries_of(constants.stiffness, pattern);
  invariants.damping = entries_of(constants.damping, pattern);
  invariants.moments.resize(pattern.nonzeros(), int_size(arrangement.pairs));
  for (std::size_t p = 0; p < arrangement.pairs.size(); ++p) {
    invariants.moments.col(p) = moment_entries(constants, arrangement.pairs[p], pattern);
  }
  return invariants;
}

BodyPlaces places_of(const BodyConstants& constants, bool is_elastic) {
  const Eigen::Index count = constants.places.size();
  BodyPlaces places;
  places.positions.resize(3, count);
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index i = 0; i < count; ++i) {
    const BodyPlace& place = constants.places[i];
    places.names.push_back(place.name);
    places.positions.col(i) = place.position;
    for (Eigen::Index k = 0; is_elastic && k < 3; ++k) {
      for (SparseMatrix::InnerIterator entry(place.displacement, k); entry; ++entry) {
        entries.emplace_back(6 * i + k, entry.col(), entry.value());
      }
      for (SparseMatrix::InnerIterator entry(place.rotation, k); entry; ++entry) {
        entries.emplace_back(6 * i + 3 + k, entry.col(), entry.value());
      }
    }
  }
  places.shape.resize(6 * count, is_elastic ? constants.size() : 0);
  places.shape.setFromTriplets(entries.begin(), entries.end());
  return places;
}

Invariants<double> rigid_part(const BodyConstants& constants) {
  return rigid_invariants<double>(constants.mass, constants.first_moment, constants.second_moment);
}

/// Effects that are part of the numbers of a file cannot be taken out of them.
void check_effects(const ImportedBody& imported, const Body& body, const EffectSettings& settings) {
  for (const auto& [name, choice] :
       {std::pair("axial_elasticity", settings.axial_elasticity),
        std::pair("torsional_elasticity", settings.torsional_elasticity),
        std::pair("rotary_inertia", settings.rotary_inertia)}) {
    if (choice != EffectChoice::off) continue;
    throw InputError(fmt::format(
        "/effects/{} is \"off\", but the body \"{}\" has the coordinates and the inertia of its "
        "file {}, from which nothing can be left out",
        name, body.name, imported.source));
  }
  const bool is_missing = !imported.file->constants.stretching;
  if (settings.geometric_stiffening == EffectChoice::on && is_missing) {
    throw InputError(fmt::format(
        "/effects/geometric_stiffening is \"on\", but the file {} of the body \"{}\" has no block "
        "\"stiffening\"",
        imported.source, body.name));
  }
}

}  // namespace

void set_imported(const ImportedBody& imported, const Body& body, const BuildContext& context,
                  BodyModel& model) {
  const BodyEffects effects = decide_effects(body, context.effects);
  model.kind = BodyKind::imported;
  model.is_elastic = effects.elasticity;
  const std::shared_ptr<const InvariantsFile> file = body_at(imported, body, context.design);
  const BodyConstants& constants = file->constants;
  std::vector<std::pair<int, const BodyConstants*>> changes;
  for (const ImportedVariable& of : imported.variables) {
    if (!of.number.is_bound() || !context.differentiation) continue;
    changes.emplace_back(of.number.variable, &*file->design[of.in_design].derivative);
  }
  // Value and derivatives of a part that is made of the constants.
  const auto set = [&](auto& value, auto& derivatives, const auto& make) {
    value = make(constants);
    for (const auto& [variable, change] : changes) derivatives.push_back({variable, make(*change)});
  };
  set(model.places, model.places_x,
      [&](const BodyConstants& of) { return places_of(of, model.is_elastic); });
  if (!model.is_elastic) {
    set(model.invariants, model.invariants_x, rigid_part);
    return;
  }
  check_effects(imported, body, context.effects);
  ArrangementFinder finder(constants.size());
  finder.add(constants);
  for (const auto& [variable, change] : changes) finder.add(*change);
  const Arrangement arrangement = finder.find();
  set(model.invariants, model.invariants_x,
      [&](const BodyConstants& of) { return invariants_of(of, arrangement); });
  if (constants.stress) {
    set(model.stress, model.stress_x, [](const BodyConstants& of) { return *of.stress; });
  }
  if (!constants.stretching) return;
  model.has_stiffening = effects.geometric_stiffening;
  set(model.stretching, model.stretching_x, [](const BodyConstants& of) { return *of.stretching; });
}

std::vector<EffectRecord> imported_records(const ImportedBody& imported,
                                           const EffectSettings& settings, const BodyModel& model) {
  using Kind = EffectRecord::Kind;
  const auto kind = [](EffectChoice choice) {
    return choice == EffectChoice::automatic ? Kind::exact : Kind::forced;
  };
  std::vector<EffectRecord> records;
  records.push_back({"elasticity",
                     model.name,
                     model.is_elastic,
                     kind(settings.elasticity),
                     settings.elasticity == EffectChoice::automatic
                         ? fmt::format("as the file {} has it", imported.source)
                         : "asked for",
                     {},
                     0});
  if (!model.is_elastic) return records;
  const EffectChoice choice = settings.geometric_stiffening;
  std::string reason = "asked for";
  if (choice == EffectChoice::automatic) {
    reason = fmt::format("the file {} {} the block \"stiffening\"", imported.source,
                         model.has_stiffening ? "has" : "lacks");
  }
  records.push_back(
      {"geometric_stiffening", model.name, model.has_stiffening, kind(choice), reason, {}, 0});
  return records;
}

}  // namespace pleuel
