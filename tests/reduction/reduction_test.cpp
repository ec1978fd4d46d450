#include "core/base/error.hpp"
#include "reduction/interface.hpp"
#include "reduction/reduce.hpp"
#include "tests/reduction/solid_block.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/files.hpp"
#include "tests/support/sample_beams.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::reduction_test {
namespace {

ReducedBody reduced(const Block& block, const std::string& kind, const std::string& more,
                    const WrittenUnits& units = {}) {
  const TemporaryFolder folder;
  const auto path = write_block_model(folder.path(), block, make_block(block), kind, more, units);
  return reduce(read_reduction_model(path.string()));
}

Eigen::MatrixXd stiffness_of(const ReducedBody& body) {
  return Eigen::MatrixXd(body.file.constants.stiffness);
}

/// Displacement of the far end per force there, six each.
Eigen::MatrixXd compliance(const Block& block, const std::string& kind) {
  const Eigen::MatrixXd k = stiffness_of(reduced(block, kind, ", \"modes\": 0"));
  return solve_dense(k, Eigen::MatrixXd::Identity(6, 6));
}

/// A prism: ∫ρ, ∫ρ x and ∫ρ x xᵀ in closed form, to the round-off of the numbers in the files.
TEST(Reduction, OfAPrismKeepsMassAndInertia) {
  const Block block;
  const BodyConstants body = reduced(block, "rigid", ", \"modes\": 2").file.constants;
  const double mass = block.density * block.area() * block.length;
  EXPECT_NEAR(body.mass / mass, 1.0, 1e-12);
  EXPECT_NEAR(body.first_moment(0) / (0.5 * mass * block.length), 1.0, 1e-12);
  EXPECT_NEAR(body.second_moment(0, 0) / (mass * block.length * block.length / 3.0), 1.0, 1e-12);
  EXPECT_NEAR(body.second_moment(1, 1) / (mass * block.height * block.height / 12.0), 1.0, 1e-12);
  EXPECT_NEAR(body.second_moment(0, 1), 0.0, 1e-12 * mass);
}

/// Without lateral contraction stretching is exact; bending is that of Timoshenko's beam with the shear
/// coefficient 5/6 of a rectangle (Cowper 1966, ν = 0), but for the ends, which cannot warp.
TEST(Reduction, OfAPrismHasTheComplianceOfABeam) {
  const Block block;
  const Eigen::MatrixXd c = compliance(block, "rigid");
  const double l = block.length, e = block.young, shear = e / 2.0 * block.area() * 5.0 / 6.0;
  EXPECT_NEAR(c(0, 0) * e * block.area() / l, 1.0, 1e-9);
  EXPECT_NEAR(c(5, 5) * e * block.inertia_z() / l, 1.0, 1e-6);
  const double bending = l * l * l / (3.0 * e * block.inertia_z()) + l / shear;
  EXPECT_NEAR(c(1, 1) / bending, 1.0, 1e-3);
}

/// A finer mesh is softer, by what coarse elements lack (Rayleigh–Ritz): 0.7 % here, most of it at the
/// ends, which cannot contract.
TEST(Reduction, OfAFinerMeshIsSofterByLittle) {
  Block block{.poisson = 0.3};
  const double coarse = compliance(block, "rigid")(1, 1);
  block.along = 16, block.up = 3;
  const double fine = compliance(block, "rigid")(1, 1);
  EXPECT_GT(fine, coarse);
  EXPECT_LT(fine, 1.01 * coarse);
}

/// Pleuel's own Timoshenko elements, clamped and free, without modes of the section. The solid has
/// stiffer ends; measured 2e-4 and 6e-4, ten times less than allowed.
TEST(Reduction, OfAPrismHasTheFrequenciesOfATimoshenkoBeam) {
  const Block block;
  const BodyConstants body = reduced(block, "rigid", ", \"modes\": 12").file.constants;
  const Eigen::VectorXd solid =
      eigenvalues_of_symmetric(Eigen::MatrixXd(body.stiffness), Eigen::MatrixXd(body.mass_matrix))
          .cwiseSqrt();
  Beam<double> beam = uniform_beam(64, block.length, rectangle_section(block.width, block.height),
                                   block.young, block.density);
  for (auto& element : beam.elements) {
    element.shear = block.young / 2.0;
    element.shear_compliance_y = 1.2 / (element.shear * block.area());
  }
  const Eigen::VectorXd in_y = frequencies(
      beam_invariants(beam, tangent_coordinates(65, bending_y), RotaryInertia::included));
  const auto distance = [&](double frequency) {
    return (solid.array() / frequency - 1.0).abs().minCoeff();
  };
  EXPECT_LT(distance(in_y(0)), 2e-3);
  EXPECT_LT(distance(in_y(1)), 6e-3);
}

/// Faces that only move on average as the interface does are softer than rigid ones: forces are spread
/// over their nodes evenly, which the elements at the end feel. Measured: 3.0 to 3.5 %.
TEST(Reduction, OfAveragedInterfacesIsSofter) {
  Block block{.poisson = 0.3};
  const Eigen::MatrixXd averaged = compliance(block, "averaged"),
                        rigid = compliance(block, "rigid");
  for (const int i : {0, 1, 2, 4, 5}) {
    EXPECT_GT(averaged(i, i), rigid(i, i)) << i;
    EXPECT_LT(averaged(i, i), 1.06 * rigid(i, i)) << i;
  }
}

/// The coordinates of an interface are its motion, whatever kind it is.
TEST(Reduction, PlacesOfInterfacesMoveByTheirCoordinates) {
  for (const std::string kind : {"rigid", "averaged"}) {
    const BodyConstants body = reduced(Block(), kind, ", \"modes\": 3").file.constants;
    ASSERT_EQ(body.places.size(), 2u);
    Eigen::MatrixXd first(6, 9), second(6, 9), expected = Eigen::MatrixXd::Zero(6, 9);
    first << Eigen::MatrixXd(body.places[0].displacement), Eigen::MatrixXd(body.places[0].rotation);
    second << Eigen::MatrixXd(body.places[1].displacement),
        Eigen::MatrixXd(body.places[1].rotation);
    expected.leftCols<6>().setIdentity();
    EXPECT_LT(first.cwiseAbs().maxCoeff(), 1e-8) << kind;
    EXPECT_LT((second - expected).cwiseAbs().maxCoeff(), 1e-8) << kind;
  }
}

/// Modes of the block with both ends held, from all of its matrices by a dense solver. A square section has each
/// bending mode twice.
TEST(Reduction, ModesWithHeldInterfacesAreThoseOfADenseSolver) {
  Block block{0.3, 0.03, 0.03, 4, 1, 1};
  const BlockModel model = make_block(block);
  std::vector<int> inner;
  for (int i = 0; i < 3 * model.positions.cols(); ++i) {
    const double x = model.positions(0, i / 3);
    if (x > 1e-9 && x < block.length - 1e-9) inner.push_back(i);
  }
  const Eigen::MatrixXd k = Eigen::MatrixXd(model.stiffness)(inner, inner);
  const Eigen::MatrixXd m = Eigen::MatrixXd(model.mass)(inner, inner);
  const Eigen::VectorXd dense = eigenvalues_of_symmetric(k, m).cwiseSqrt();
  const ReducedBody body = reduced(block, "rigid", ", \"modes\": 10");
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(body.frequencies(i) / dense(i), 1.0, 1e-8) << i;
  EXPECT_NEAR(body.next_frequency / dense(10), 1.0, 1e-8);
  EXPECT_NEAR(body.frequencies(0) / body.frequencies(1), 1.0, 1e-8);
}

TEST(Reduction, KeepsAllModesBelowAFrequency) {
  const ReducedBody few = reduced(Block(), "rigid", ", \"modes\": {\"below\": \"3 kHz\"}");
  const ReducedBody many = reduced(Block(), "rigid", ", \"modes\": 9");
  const auto below = (many.frequencies.array() < 6000.0 * std::numbers::pi).count();
  EXPECT_EQ(few.frequencies.size(), below);
  EXPECT_GT(few.next_frequency, 6000.0 * std::numbers::pi);
}

/// Frequencies of the body that is held at one end only, of all of its coordinates.
Eigen::VectorXd clamped_frequencies(const ReducedBody& body) {
  const BodyConstants& constants = body.file.constants;
  return eigenvalues_of_symmetric(Eigen::MatrixXd(constants.stiffness),
                                  Eigen::MatrixXd(constants.mass_matrix))
      .cwiseSqrt();
}

/// In place of modes: above the frequencies by many modes (Rayleigh), the lowest four, two of bending in each
/// plane, by less than 1e-4; a third generation adds digits.
TEST(Reduction, ResponsesToInertiaAreAsGoodAsModes) {
  const auto by = [](const std::string& modes) {
    return clamped_frequencies(reduced(Block(), "rigid", ", \"modes\": " + modes));
  };
  const Eigen::VectorXd exact = by("60"), two = by("{\"inertia_responses\": 2}"),
                        three = by("{\"inertia_responses\": 3}");
  ASSERT_EQ(two.size(), 6 + 12);
  for (int i = 0; i < 4; ++i) {
    EXPECT_GT(two(i), exact(i) * (1.0 - 1e-8)) << i;
    EXPECT_LT(two(i), exact(i) * (1.0 + 1e-4)) << i;
    EXPECT_LT(three(i), two(i) * (1.0 + 1e-10)) << i;
  }
}

/// From 40 to 30 mm of height the third mode in the plane changes from bending to stretching. Responses go
/// on: a step of 1e-4 changes numbers by the third power of 1e-4, not more.
TEST(Reduction, ResponsesToInertiaGoContinuouslyWithTheBody) {
  const auto stiffness_at = [](double height) {
    Block block{.height = height};
    return stiffness_of(reduced(block, "rigid", ", \"modes\": {\"inertia_responses\": 2}"));
  };
  for (double height = 0.03; height < 0.041; height += 0.002) {
    const Eigen::MatrixXd here = stiffness_at(height), beside = stiffness_at(height * (1.0 + 1e-4));
    const Eigen::VectorXd size = here.diagonal().cwiseSqrt();
    const Eigen::MatrixXd change =
        (beside - here).cwiseAbs().array() / (size * size.transpose()).array();
    EXPECT_LT(change.maxCoeff(), 1e-3) << height;
  }
}

/// In mm, t and s the same body has other numbers, and reads as the same in SI.
TEST(Reduction, OfMillimetresAndTonnesIsTheSame) {
  Block block{.poisson = 0.3};
  const std::string more =
      ", \"modes\": 2, \"damping\": \"1e-5 s\", \"stress\": {\"nodes\": \"surface\", \"most\": 5}, "
      "\"stiffening\": {\"from\": \"left\", \"to\": \"right\", \"elements\": 4}";
  const ReducedBody si = reduced(block, "rigid", more);
  const ReducedBody mm = reduced(block, "rigid", more, {"mm-t-s", 1e-3, 1e3, 1.0});
  const auto expect_same = [](const SparseMatrix& a, const SparseMatrix& b) {
    const Eigen::MatrixXd x(a), y(b);
    EXPECT_LT((x - y).cwiseAbs().maxCoeff(), 1e-7 * x.cwiseAbs().maxCoeff());
  };
  const BodyConstants &a = si.file.constants, &b = mm.file.constants;
  expect_same(a.stiffness, b.stiffness);
  expect_same(a.damping, b.damping);
  expect_same(a.mass_matrix, b.mass_matrix);
  expect_same(a.mixed, b.mixed);
  expect_same(a.stress->of_coordinates, b.stress->of_coordinates);
  EXPECT_NEAR(a.stretching->elements[1].axial_stiffness / b.stretching->elements[1].axial_stiffness,
              1.0, 1e-8);
  EXPECT_THAT(mm.findings, IsEmpty());
}

TEST(Reduction, SaysWhichUnitsWereUnderstoodWhereNoMaterialHasThem) {
  const ReducedBody body = reduced(Block(), "rigid", ", \"modes\": 0", {"m-kg-s", 1e-3, 1e3, 1.0});
  EXPECT_THAT(body.findings, testing::Contains(AllOf(HasSubstr("kg/m³"), HasSubstr("units"))));
}

/// The largest bending stress M c/I under a force on the far end, at nodes on the top in the middle.
TEST(Reduction, StressIsThatOfABentBeam) {
  const Block block;
  const ReducedBody body =
      reduced(block, "rigid",
              ", \"modes\": 0, \"stress\": {\"nodes\": {\"box\": [[0.2, 0.02, -1], "
              "[0.2, 0.02, 1]]}}");
  const StressRecovery& stress = *body.file.constants.stress;
  ASSERT_EQ(stress.points.size(), 3u);
  const Eigen::VectorXd force = Eigen::VectorXd::Unit(6, 1);
  const Eigen::VectorXd sigma = stress.of_coordinates * solve_dense(stiffness_of(body), force);
  const double expected = -0.5 * block.length * 0.5 * block.height / block.inertia_z();
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(sigma(6 * i) / expected, 1.0, 1e-6);
    EXPECT_NEAR(sigma(6 * i + 1) / expected, 0.0, 1e-6);
  }
}

/// The nodes that are kept have the largest stress of all for loads on the interface.
TEST(Reduction, KeepsTheNodesOfTheLargestStress) {
  const std::string most = ", \"modes\": 0, \"stress\": {\"nodes\": \"surface\", \"most\": 24}";
  const std::string all = ", \"modes\": 0, \"stress\": {\"nodes\": \"surface\"}";
  const ReducedBody some = reduced(Block(), "rigid", most), every = reduced(Block(), "rigid", all);
  ASSERT_LE(some.file.constants.stress->points.size(), 24u);
  ASSERT_GT(every.file.constants.stress->points.size(), 50u);
  for (const int direction : {0, 1, 2, 4, 5}) {
    const auto largest = [&](const ReducedBody& body) {
      const Eigen::VectorXd q =
          solve_dense(stiffness_of(body), Eigen::VectorXd::Unit(6, direction));
      const Eigen::VectorXd sigma = body.file.constants.stress->of_coordinates * q;
      return sigma(Eigen::seq(0, Eigen::last, 6)).cwiseAbs().maxCoeff();
    };
    EXPECT_NEAR(largest(some) / largest(every), 1.0, 1e-2) << direction;
  }
}

/// Euler's column, clamped and free, π²EI/4L², with the softening by shear of Engesser: 1/P = 1/P_E + 1/(κGA).
/// The lumped line is a polygon: 12 elements are measured to cost 2e-3.
TEST(Reduction, LumpedStiffeningBucklesAsEulersColumn) {
  const Block block{0.4, 0.02, 0.04, 12, 1, 1};
  const ReducedBody body =
      reduced(block, "rigid",
              ", \"modes\": 12, \"stiffening\": {\"from\": \"left\", \"to\": \"right\", "
              "\"elements\": 12}");
  const Stretching& line = *body.file.constants.stretching;
  const Eigen::MatrixXd d(line.displacements);
  Eigen::MatrixXd geometric = Eigen::MatrixXd::Zero(d.cols(), d.cols());
  for (const StretchedElement& element : line.elements) {
    const Eigen::MatrixXd rows = d(element.displacements, Eigen::all);
    geometric += rows.transpose() * element.slopes * rows;
    EXPECT_NEAR(element.axial_stiffness * block.length / 12.0 / (block.young * block.area()), 1.0,
                0.02);
  }
  // K φ = P G φ: the largest 1/P.
  const Eigen::VectorXd inverse = eigenvalues_of_symmetric(geometric, stiffness_of(body));
  const double euler =
      std::pow(std::numbers::pi / block.length, 2) / 4.0 * block.young * block.inertia_z();
  const double shear = block.young / 2.0 * block.area() * 5.0 / 6.0;
  EXPECT_NEAR(inverse.maxCoeff() * euler, 1.0 + euler / shear, 1e-2);
}

std::string message_of(const Block& block, const BlockModel& model, const std::string& kind,
                       const std::string& more) {
  const TemporaryFolder folder;
  const auto path = write_block_model(folder.path(), block, model, kind, more);
  return thrown<InputError>([&] { reduce(read_reduction_model(path.string())); });
}

TEST(ReductionErrors, TellWhatIsWrongWithTheModel) {
  const Block block{0.4, 0.04, 0.03, 4, 1, 1};
  const BlockModel model = make_block(block);
  BlockModel held = model;
  held.stiffness.coeffRef(30, 30) *= 2.0;
  EXPECT_THAT(message_of(block, held, "rigid", ", \"modes\": 1"), HasSubstr("K r"));
  BlockModel shells = model;
  shells.mass.coeffRef(4, 4) *= 1.1;
  EXPECT_THAT(message_of(block, shells, "rigid", ", \"modes\": 1"), HasSubstr("the same in x, y"));
  EXPECT_THAT(message_of(block, model, "glued", ", \"modes\": 1"), HasSubstr("\"averaged\""));
  EXPECT_THAT(message_of(block, model, "rigid", ", \"modes\": -1"), HasSubstr("/modes"));
  EXPECT_THAT(
      message_of(block, model, "rigid", ", \"modes\": 1, \"stress\": {\"nodes\": \"lefft\"}"),
      HasSubstr("LEFT"));
  EXPECT_THAT(message_of(block, model, "rigid",
                         ", \"modes\": 1, \"stress\": {\"nodes\": {\"box\": [[9, 9, 9], [9, 9, "
                         "9]]}}"),
              HasSubstr("reaches from"));
}

/// Two blocks side by side that share no node, each with an interface.
TEST(ReductionErrors, TellInterfacesThatAreNotConnected) {
  const Block block{0.4, 0.04, 0.03, 2, 1, 1};
  BlockModel model = make_block(block);
  const BlockModel whole = model;
  // The second element gets nodes of its own where it touched the first.
  std::vector<int> doubled;
  for (int i = 0; i < 20; ++i) {
    int& node = model.elements(i, 1);
    if (std::abs(whole.positions(0, node) - 0.2) > 1e-9) continue;
    doubled.push_back(node);
    node = static_cast<int>(whole.positions.cols() + doubled.size()) - 1;
  }
  model.positions.conservativeResize(3, whole.positions.cols() + int(doubled.size()));
  for (std::size_t i = 0; i < doubled.size(); ++i) {
    model.positions.col(whole.positions.cols() + int(i)) = whole.positions.col(doubled[i]);
  }
  model.stiffness.resize(3 * model.positions.cols(), 3 * model.positions.cols());
  model.mass = model.stiffness;
  EXPECT_THAT(message_of(block, model, "rigid", ", \"modes\": 1"), HasSubstr("not connected"));
}

ReducedBody reduced_bar(int modes, const std::string& more) {
  const TemporaryFolder folder;
  Block block{0.4, 0.04, 0.03, 6, 2, 2};
  block.poisson = 0.3;
  const auto path = write_block_model(folder.path(), block, make_block(block), "rigid",
                                      fmt::format(", \"modes\": {}{}", modes, more));
  return reduce(read_reduction_model(path.string()));
}

/// The coordinates in the plane and the others share no stiffness and no inertia in a symmetric body: those that
/// are kept have the matrices that they had among all of them.
TEST(PlaneMotion, KeepsTheCoordinatesInThePlaneAsTheyAre) {
  const ReducedBody all = reduced_bar(20, ""), some = reduced_bar(6, ", \"plane\": \"z = 0\"");
  std::vector<int> kept = {0, 1, 5};  // u, v, rz
  for (const double frequency : some.frequencies) {
    Eigen::Index nearest = 0;
    const double off = (all.frequencies.array() - frequency).abs().minCoeff(&nearest);
    EXPECT_LT(off, 1e-8 * frequency);
    kept.push_back(6 + static_cast<int>(nearest));
  }
  EXPECT_THAT(
      std::vector<std::string>(some.file.coordinates.begin(), some.file.coordinates.begin() + 3),
      ElementsAre("u of right", "v of right", "rz of right"));
  EXPECT_EQ(kept.size(), 9u);
  EXPECT_LT(some.asymmetry, 1e-9);
  const Eigen::MatrixXd k(all.file.constants.stiffness), m(all.file.constants.mass_matrix);
  // Modes may have other signs.
  const auto difference = [&](const SparseMatrix& one, const Eigen::MatrixXd& other) {
    return (Eigen::MatrixXd(one).cwiseAbs() - other(kept, kept).cwiseAbs()).norm() / other.norm();
  };
  EXPECT_LT(difference(some.file.constants.stiffness, k), 1e-9);
  EXPECT_LT(difference(some.file.constants.mass_matrix, m), 1e-9);
  for (int i = 0; i < static_cast<int>(k.rows()); ++i) {
    if (std::find(kept.begin(), kept.end(), i) != kept.end()) continue;
    // Higher ones may be of the plane, too.
    if (i >= 6 && all.frequencies(i - 6) > some.frequencies.tail(1)(0)) continue;
    for (const int j : kept) {
      EXPECT_NEAR(k(i, j), 0.0, 1e-8 * std::sqrt(k(i, i) * k(j, j))) << i << " " << j;
      EXPECT_NEAR(m(i, j), 0.0, 1e-8 * std::sqrt(m(i, i) * m(j, j))) << i << " " << j;
    }
  }
}

/// What a planar mechanism asks of a body: nothing couples z with x and y. Poisson's effect stays.
TEST(PlaneMotion, LeavesNothingAcrossThePlane) {
  const BodyConstants body = reduced_bar(6, ", \"plane\": \"z = 0\"").file.constants;
  EXPECT_EQ(Eigen::MatrixXd(body.shape).row(2).norm(), 0.0);
  EXPECT_EQ(Eigen::MatrixXd(body.moments[4]).norm(), 0.0);
  EXPECT_EQ(Eigen::MatrixXd(body.moments[5]).norm(), 0.0);
  EXPECT_GT(Eigen::MatrixXd(body.moments[2]).norm(), 0.0);
  for (const BodyPlace& place : body.places) {
    EXPECT_EQ(Eigen::MatrixXd(place.displacement).row(2).norm(), 0.0);
    EXPECT_EQ(Eigen::MatrixXd(place.rotation).topRows<2>().norm(), 0.0);
  }
}

}  // namespace
}  // namespace pleuel::test::reduction_test
