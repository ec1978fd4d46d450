#include "core/scene/beam_mesh.hpp"
#include "core/scene/material_library.hpp"
#include "core/scene/problem_reader.hpp"
#include "tests/scene/good_problem.hpp"
#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::section_reading_test {
namespace {

const BeamBody& crank_of(const ProblemFile& problem) {
  return std::get<BeamBody>(problem.scene.bodies[0].shape);
}

/// The section of the good problem's crank after it is replaced. `width` is a variable still.
Section read_crank_section(const std::string& section) {
  return crank_of(read(edited("/scene/bodies/crank/section", section))).segments[0].section;
}

/// Of a number that is the variable `width`, the first one.
void expect_width(const Number& number, double factor = 1.0) {
  EXPECT_EQ(number.variable, 0);
  EXPECT_EQ(number.factor, factor);
}

TEST(SectionReading, KnowsTheEllipse) {
  const auto ellipse = std::get<EllipseSection>(read_crank_section(
      R"({"type": "ellipse", "width": "10 mm", "height": {"variable": "width", "factor": 2}})"));
  EXPECT_EQ(ellipse.width.constant, 0.01);
  expect_width(ellipse.height, 2.0);
}

TEST(SectionReading, KnowsTheBox) {
  const auto box = std::get<BoxSection>(read_crank_section(
      R"({"type": "box", "width": {"variable": "width"}, "height": 0.03, "thickness": "2 mm"})"));
  expect_width(box.width);
  EXPECT_EQ(box.height.constant, 0.03);
  EXPECT_EQ(box.thickness.constant, 0.002);
}

TEST(SectionReading, KnowsTheI) {
  const auto i = std::get<ISection>(read_crank_section(
      R"({"type": "i", "width": {"variable": "width"}, "height": "80 mm",
          "flange_thickness": "5 mm", "web_thickness": "4 mm"})"));
  expect_width(i.width);
  EXPECT_EQ(i.height.constant, 0.08);
  EXPECT_EQ(i.flange_thickness.constant, 0.005);
  EXPECT_EQ(i.web_thickness.constant, 0.004);
}

TEST(SectionReading, KnowsTheGeneralSection) {
  Json document = edited("/scene/bodies/crank/section",
                         R"({"type": "general", "area": {"variable": "area"}, "inertia_y": "1 cm^4",
          "inertia_z": 2e-8, "torsion": "3e4 mm^4",
          "points": [{"y": 0.02, "z": "-5 mm", "shear": "0.5 1/cm^3"}, {"y": 0, "z": 0, "shear": 0}]})");
  document["variables"].erase("width");
  document["variables"]["area"] =
      Json::parse(R"({"start": "4 cm^2", "lower": 1e-4, "upper": 1e-3})");
  document["constraints"].erase("slender");
  const ProblemFile problem = read(document);
  const auto section = std::get<GeneralSection>(crank_of(problem).segments[0].section);
  EXPECT_EQ(problem.variables.back().name, "area");
  EXPECT_DOUBLE_EQ(problem.variables.back().start, 4e-4);
  EXPECT_EQ(section.area.variable, 2);
  EXPECT_DOUBLE_EQ(section.inertia_y.constant, 1e-8);
  EXPECT_EQ(section.inertia_z.constant, 2e-8);
  EXPECT_DOUBLE_EQ(section.torsion.constant, 3e-8);
  ASSERT_EQ(section.points.size(), 2U);
  EXPECT_EQ(section.points[0].y.constant, 0.02);
  EXPECT_DOUBLE_EQ(section.points[0].z.constant, -0.005);
  EXPECT_DOUBLE_EQ(section.points[0].shear.constant, 0.5e6);
}

/// The good problem in the folder of the shipped catalogue.
ProblemFile read_beside_catalogue(Json document) {
  document["scene"]["catalogue"] = "catalogue.json";
  return read_problem_text(document.dump(), source_folder() + "/problems/any.json").complete();
}

TEST(Catalogue, StandsForTheSectionOfThatName) {
  const ProblemFile problem = read_beside_catalogue(
      edited("/scene/bodies/rod/segments/1/section", R"({"catalogue": "CHS 48.3x2.6"})"));
  const auto tube =
      std::get<TubeSection>(std::get<BeamBody>(problem.scene.bodies[1].shape).segments[1].section);
  EXPECT_DOUBLE_EQ(tube.outer_diameter.constant, 0.0483);
  EXPECT_DOUBLE_EQ(tube.thickness.constant, 0.0026);
}

TEST(Catalogue, NameCanBeOverridden) {
  Json document = edited("/scene/bodies/rod/segments/1/section", R"({"catalogue": "round 20"})");
  document["scene"]["catalogue"] = "catalogue.json";
  const ProblemFile problem =
      read_problem_text(document.dump(), source_folder() + "/problems/any.json",
                        {"/scene/bodies/rod/segments/1/section/catalogue=round 25"})
          .complete();
  const auto circle = std::get<CircleSection>(
      std::get<BeamBody>(problem.scene.bodies[1].shape).segments[1].section);
  EXPECT_DOUBLE_EQ(circle.diameter.constant, 0.025);
}

TEST(Materials, OfTheLibraryNeedNoDeclaration) {
  const ProblemFile problem =
      read(edited("/scene/bodies/crank/material", R"("aluminium-6082-T6")"));
  ASSERT_EQ(problem.scene.materials.size(), 3U);  // two of its own; no more than is used
  const Material& material = problem.scene.materials.back();
  EXPECT_EQ(material.name, "aluminium-6082-T6");
  EXPECT_EQ(material.young.constant, 70e9);  // EN 1999-1-1
  ASSERT_TRUE(material.strength.has_value());
  EXPECT_EQ(material.strength->constant, 250e6);  // EN 755-2
}

TEST(Materials, OfTheSceneTakePrecedence) {
  Json document =
      edited("/scene/materials/pom", R"({"young": "3 GPa", "poisson": 0.4, "density": 1400})");
  document["scene"]["bodies"]["crank"]["material"] = "pom";
  const ProblemFile problem = read(document);
  ASSERT_EQ(problem.scene.materials.size(), 3U);
  EXPECT_EQ(problem.scene.materials.back().young.constant, 3e9);
  EXPECT_FALSE(problem.scene.materials.back().strength.has_value());
}

TEST(Materials, StrengthCanBeDesigned) {
  Json document = edited("/scene/materials/steel/strength", R"({"variable": "yield"})");
  document["variables"]["yield"] =
      Json::parse(R"({"start": "355 MPa", "lower": 2e8, "upper": "1 GPa"})");
  const ProblemFile problem = read(document);
  ASSERT_TRUE(problem.scene.materials[0].strength.has_value());
  EXPECT_EQ(problem.scene.materials[0].strength->variable, 3);
  EXPECT_DOUBLE_EQ(problem.variables.back().start, 355e6);
}

TEST(Materials, OfTheLibraryAreWhatAMaterialCanBe) {
  std::vector<std::string> names;
  for (const Material& material : material_library()) {
    SCOPED_TRACE(material.name);
    EXPECT_THAT(names, Not(testing::Contains(material.name)));
    names.push_back(material.name);
    ASSERT_TRUE(material.strength.has_value());
    // Yield strains of engineering materials: 0.05 % (soft) to 3 % (plastics).
    const double strain = material.strength->constant / material.young.constant;
    EXPECT_GT(strain, 0.0005);
    EXPECT_LT(strain, 0.03);
    EXPECT_GT(material.poisson.constant, 0.2);
    EXPECT_LT(material.poisson.constant, 0.4);
    // From polymers to steel: Ashby's chart of moduli and densities.
    EXPECT_GT(material.density.constant, 1000.0);
    EXPECT_LT(material.density.constant, 8000.0);
  }
  EXPECT_GE(names.size(), 8U);
}

/// The numbers of the standards and handbooks that the library names: E [GPa], ν, ρ [kg/m³], yield
/// strength [MPa].
TEST(Materials, OfTheLibraryHaveTheNumbersOfTheirStandards) {
  struct Row {
    const char* name;
    double young, poisson, density, strength;
  };
  for (const Row& row : {Row{"steel", 210, 0.3, 7850, 355},                       // EN 1993-1-1
                         Row{"high-strength-steel", 210, 0.3, 7850, 960},         // EN 10025-6
                         Row{"heat-treated-steel-42CrMo4", 210, 0.3, 7850, 650},  // EN ISO 683-2
                         Row{"stainless-steel", 200, 0.3, 7900, 190},             // EN 10088
                         Row{"ductile-iron-GJS-400-15", 169, 0.275, 7100, 250},   // EN 1563
                         Row{"aluminium-6082-T6", 70, 0.33, 2700, 250},           // EN 755-2
                         Row{"aluminium-7075-T6", 71.7, 0.33, 2810, 480},         // EN 755-2
                         Row{"titanium-Ti6Al4V", 113.8, 0.342, 4430, 828},        // ASTM B348
                         Row{"magnesium-AZ31", 45, 0.35, 1770, 145},              // ASTM B107
                         Row{"cfrp-quasi-isotropic", 69.7, 0.296, 1600, 270},     // see below
                         Row{"pom", 2.85, 0.37, 1410, 64}}) {                     // ISO 527
    const std::vector<Material> library = material_library();
    const auto found = std::find_if(library.begin(), library.end(), [&](const Material& material) {
      return material.name == row.name;
    });
    ASSERT_NE(found, library.end()) << row.name;
    EXPECT_DOUBLE_EQ(found->young.constant, row.young * 1e9) << row.name;
    EXPECT_DOUBLE_EQ(found->poisson.constant, row.poisson) << row.name;
    EXPECT_DOUBLE_EQ(found->density.constant, row.density) << row.name;
    EXPECT_DOUBLE_EQ(found->strength->constant, row.strength * 1e6) << row.name;
  }
}

/// Classical lamination theory: with the invariants of the ply, Q₁₁ = E₁/(1 − ν₁₂ν₂₁) …,
///     A₁₁ = U₁ = (3Q₁₁ + 3Q₂₂ + 2Q₁₂ + 4Q₆₆)/8,   A₁₂ = U₄ = (Q₁₁ + Q₂₂ + 6Q₁₂ − 4Q₆₆)/8
/// of a quasi-isotropic laminate; E = A₁₁ − A₁₂²/A₁₁ and ν = A₁₂/A₁₁. Plies of Tsai & Hahn 1980.
TEST(Materials, CarbonFibreIsTheLaminateOfItsPlies) {
  const double e1 = 181e9, e2 = 10.3e9, g12 = 7.17e9, nu12 = 0.28, transverse_strength = 40e6;
  const double scale = 1 - nu12 * nu12 * e2 / e1;
  const double q11 = e1 / scale, q22 = e2 / scale, q12 = nu12 * e2 / scale;
  const double a11 = (3 * q11 + 3 * q22 + 2 * q12 + 4 * g12) / 8;
  const double a12 = (q11 + q22 + 6 * q12 - 4 * g12) / 8;
  const double young = a11 - a12 * a12 / a11;
  for (const Material& material : material_library()) {
    if (material.name != "cfrp-quasi-isotropic") continue;
    EXPECT_NEAR(material.young.constant, young, 0.05e9);  // rounded to these digits
    EXPECT_NEAR(material.poisson.constant, a12 / a11, 0.0005);
    EXPECT_NEAR(material.strength->constant, young * transverse_strength / e2, 1e6);
    return;
  }
  FAIL() << "there is none";
}

using testing::Pointwise;

/// A beam of 1 m along x with loads at places [m].
struct LoadedBeam {
  std::vector<Segment> segments;
  std::vector<Number> places;

  Scene scene() const {
    BeamBody beam;
    beam.from = {0.0, 0.0, 0.0};
    beam.to = {1.0, 0.0, 0.0};
    beam.segments = segments;
    Scene scene;
    scene.bodies.push_back({"beam", beam});
    for (const Number& place : places) {
      PointLoad force;
      force.body = "beam";
      force.at = {place, 0.0, 0.0};
      scene.loads.push_back({"load", force});
    }
    return scene;
  }
};

BeamMesh mesh_of(const LoadedBeam& loaded, const Design<double>& start) {
  const Scene scene = loaded.scene();
  return make_mesh(scene.bodies.front(), scene, start, true);
}

std::vector<double> shares_of(const LoadedBeam& loaded, const Design<double>& start,
                              const Design<double>& design) {
  const Scene scene = loaded.scene();
  return element_shares(std::get<BeamBody>(scene.bodies.front().shape),
                        make_mesh(scene.bodies.front(), scene, start, true), design);
}

std::vector<Segment> even(int elements) {
  return {{CircleSection{0.02}, elements, {}}};
}

MATCHER(AreClose, "") {
  return std::abs(std::get<0>(arg) - std::get<1>(arg)) < 1e-14;
}

TEST(BeamMesh, IsDividedAtPlaces) {
  const LoadedBeam loaded{even(4), {0.3, 0.5}};
  EXPECT_THAT(shares_of(loaded, {}, {}), Pointwise(AreClose(), {0.25, 0.05, 0.2, 0.25, 0.25}));
  EXPECT_THAT(mesh_of(loaded, {}).attached_nodes, ElementsAre(2, 3));
  EXPECT_FALSE(mesh_of(loaded, {}).depends_on_design());
}

/// Within a hundredth of an element, where nothing holds the node.
TEST(BeamMesh, MovesTheNodeToAPlaceBesideIt) {
  const LoadedBeam loaded{even(4), {0.501, 0.249}};
  EXPECT_THAT(shares_of(loaded, {}, {}), Pointwise(AreClose(), {0.249, 0.252, 0.249, 0.25}));
  EXPECT_THAT(mesh_of(loaded, {}).attached_nodes, ElementsAre(1, 2));
}

/// An end, a boundary of segments and another place stay where they are.
TEST(BeamMesh, HasANodeBesideOneThatIsHeld) {
  LoadedBeam loaded{even(2), {0.501, 0.25, 0.251}};
  loaded.segments.push_back(loaded.segments.front());
  EXPECT_THAT(shares_of(loaded, {}, {}),
              Pointwise(AreClose(), {0.25, 0.001, 0.249, 0.001, 0.249, 0.25}));
}

/// Within a thousandth of the element.
TEST(BeamMesh, LeavesAPlaceInsideThatIsNextToOneThatIsHeld) {
  LoadedBeam loaded{even(2), {0.5002, 0.9999}};
  loaded.segments.push_back(loaded.segments.front());
  EXPECT_THAT(shares_of(loaded, {}, {}), Pointwise(AreClose(), {0.25, 0.25, 0.25, 0.25}));
  EXPECT_THAT(mesh_of(loaded, {}).attached_nodes, ElementsAre());
  const ElementPlace inside = find_place(mesh_of(loaded, {}), 0.5002);
  EXPECT_EQ(inside.element, 2);
  EXPECT_NEAR(inside.xi, 0.0008, 1e-12);
}

/// Between the ends the elements of both sides change by one factor.
TEST(BeamMesh, FollowsAPlaceThatAVariableMoves) {
  const LoadedBeam loaded{even(4), {Number::bound(0)}};
  EXPECT_TRUE(mesh_of(loaded, {0.5}).depends_on_design());
  EXPECT_THAT(shares_of(loaded, {0.5}, {0.5}), Pointwise(AreClose(), {0.25, 0.25, 0.25, 0.25}));
  EXPECT_THAT(shares_of(loaded, {0.5}, {0.8}), Pointwise(AreClose(), {0.4, 0.4, 0.1, 0.1}));
}

TEST(BeamMesh, HoldsOtherPlacesAndBoundariesWhereTheyAre) {
  LoadedBeam loaded{even(2), {Number::bound(0), 0.25}};
  loaded.segments.push_back(loaded.segments.front());
  EXPECT_THAT(shares_of(loaded, {0.75}, {0.6}), Pointwise(AreClose(), {0.25, 0.25, 0.1, 0.4}));
  EXPECT_THAT(shares_of(loaded, {0.4}, {0.3}),
              Pointwise(AreClose(), {0.25, 0.05, 0.2, 0.25, 0.25}));
}

/// At an end and at a boundary there is no node that could go with it.
TEST(BeamMesh, DoesNotFollowFromAnEndOrABoundary) {
  LoadedBeam loaded{even(2), {Number::bound(0)}};
  loaded.segments.push_back(loaded.segments.front());
  EXPECT_FALSE(mesh_of(loaded, {0.5}).depends_on_design());
  EXPECT_FALSE(mesh_of(loaded, {1.0}).depends_on_design());
}

}  // namespace
}  // namespace pleuel::test::section_reading_test
