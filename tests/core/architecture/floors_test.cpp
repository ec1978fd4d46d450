#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>

#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::floors_test {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

struct Include {
  std::string file, folder, header;  ///< relative to the root of the repository
};

/// A line of a source outside tests/.
struct Line {
  std::string file;  ///< relative to the root of the repository
  std::string text;
};

std::vector<Line> read_lines() {
  std::vector<Line> lines;
  const fs::path root = pleuel::source_folder();
  for (const char* top : {"core", "sensitivity", "optimization", "record", "reduction", "studies",
                          "picture", "mpi", "cli", "library"}) {
    if (!fs::exists(root / top)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
      std::ifstream stream(entry.path());
      const std::string file = fs::relative(entry.path(), root).generic_string();
      for (std::string line; std::getline(stream, line);) lines.push_back({file, line});
    }
  }
  return lines;
}

std::vector<Include> read_includes() {
  std::vector<Include> includes;
  for (const auto& [file, line] : read_lines()) {
    if (!line.starts_with("#include")) continue;
    const auto begin = line.find_first_of("<\"") + 1, end = line.find_first_of(">\"", begin);
    includes.push_back(
        {file, fs::path(file).parent_path().generic_string(), line.substr(begin, end - begin)});
  }
  return includes;
}

/// The floor that a file or header belongs to: "core/beam", "sensitivity", …; empty if foreign.
std::string floor_of(const std::string& path) {
  if (path.starts_with("optimization/design/")) return "optimization/design";
  for (const std::string top : {"sensitivity", "optimization", "record", "reduction", "studies",
                                "picture", "mpi", "cli", "library"}) {
    if (path.starts_with(top + "/")) return top;
  }
  if (!path.starts_with("core/")) return "";
  return path.substr(0, path.find('/', 5));
}

/// Who may include whom (docs/architecture.md), with everything that lies below.
const std::map<std::string, Names>& permitted() {
  static const std::map<std::string, Names> floors = [] {
    std::map<std::string, Names> below = {
        {"core/base", {}},
        {"core/jobs", {"core/base"}},
        {"core/scene", {"core/jobs"}},
        {"core/section", {"core/base"}},
        {"core/beam", {"core/section"}},
        {"core/frame", {"core/base"}},
        {"core/system", {"core/base"}},
        {"core/effects", {"core/beam", "core/frame", "core/system"}},
        {"core/joints", {"core/frame", "core/system"}},
        {"core/forces", {"core/frame", "core/system"}},
        {"core/mechanism", {"core/system"}},
        {"core/linear", {"core/mechanism"}},
        {"core/start", {"core/linear"}},
        {"core/integration", {"core/start"}},
        {"core/model",
         {"core/scene", "core/beam", "core/frame", "core/integration", "core/effects",
          "core/joints", "core/forces"}},
        {"core/mobility", {"core/model", "core/mechanism"}},
        {"core/response",
         {"core/mobility", "core/model", "core/scene", "core/beam", "core/integration"}},
        {"core/trust", {"core/response"}},
        {"sensitivity", {"core/response"}},
        {"optimization", {"core/jobs"}},
        {"optimization/design", {"optimization", "sensitivity", "core/trust"}},
        {"record", {"optimization"}},
        {"reduction", {"core/scene"}},
        {"studies", {"optimization/design"}},
        {"picture", {"core/response"}},
        {"mpi", {}},
        {"cli", {"studies", "picture", "record", "reduction"}},
        {"library", {"cli"}}};
    for (int i = 0; i < 12; ++i) {  // what lies below what lies below …
      for (auto& [floor, names] : below) {
        for (const std::string& name : Names(names))
          names.insert(below[name].begin(), below[name].end());
      }
    }
    return below;
  }();
  return floors;
}

/// Among them: the generic optimizer, which knows no mechanics, can be taken out and used for
/// anything; optimization/design alone joins the two.
TEST(Floors, StandOnlyOnThoseBelow) {
  for (const auto& [file, folder, header] : read_includes()) {
    const std::string from = floor_of(file), to = floor_of(header);
    if (to.empty() || from == to) continue;
    ASSERT_TRUE(permitted().contains(from)) << file;
    EXPECT_TRUE(permitted().at(from).contains(to)) << file << " includes " << header;
  }
}

/// One place knows both what the user asked for and how it moves.
TEST(Floors, OnlyTheModelKnowsSceneAndTerms) {
  std::map<std::string, Names> floors_of_folder;
  for (const auto& [file, folder, header] : read_includes()) {
    floors_of_folder[floor_of(file)].insert(floor_of(header));
  }
  for (const auto& [floor, included] : floors_of_folder) {
    const bool knows_terms = included.contains("core/effects") ||
                             included.contains("core/joints") || included.contains("core/forces");
    EXPECT_EQ(knows_terms && included.contains("core/scene"), floor == "core/model") << floor;
  }
}

TEST(Floors, KeepForeignLibrariesBehindTheirDoors) {
  struct Door {
    const char *header, *file;
  };
  // A prefix of the header, a prefix of the only files that may include it.
  for (const auto& [header, door] : {Door{"klu.h", "core/mechanism/"},
                                     {"camd.h", "core/mechanism/linear_solver.cpp"},
                                     {"lapacke.h", "core/base/dense_solvers.cpp"},
                                     {"dmumps_c.h", "reduction/symmetric_solver.cpp"},
                                     {"nlopt.h", "optimization/nlopt_optimizer.cpp"},
                                     {"Ip", "optimization/ipopt_optimizer.cpp"},
                                     {"coin", "optimization/ipopt_optimizer.cpp"},
                                     {"udunits2.h", "core/scene/units.cpp"},
                                     {"sqlite3.h", "record/sqlite.cpp"}}) {
    for (const auto& include : read_includes()) {
      if (!include.header.starts_with(header)) continue;
      EXPECT_TRUE(include.file.starts_with(door)) << include.file << " includes " << include.header;
    }
  }
}

/// JSON is for the scene's reader, and for what the command and the studies write.
TEST(Floors, KeepJsonOutOfTheMechanics) {
  for (const auto& [file, folder, header] : read_includes()) {
    if (!header.starts_with("nlohmann/")) continue;
    const std::string floor = floor_of(file);
    EXPECT_TRUE(floor == "core/scene" || floor == "cli" || floor == "studies") << file;
  }
}

/// A file without its ending: a header and what it declares are one.
std::string unit_of(const std::string& path) {
  return path.substr(0, path.rfind('.'));
}

/// The units that each unit includes.
std::map<std::string, Names> includes_of_units() {
  std::map<std::string, Names> units;
  for (const auto& [file, folder, header] : read_includes()) {
    if (unit_of(file) != unit_of(header)) units[unit_of(file)].insert(unit_of(header));
  }
  return units;
}

/// Units from which nothing remains to be read but themselves: taken away again and again, all go.
TEST(Files, IncludeEachOtherInNoCircle) {
  std::map<std::string, Names> units = includes_of_units();
  std::size_t before = 0;
  while (units.size() != before) {
    before = units.size();
    std::erase_if(units, [&](const auto& unit) {
      return std::none_of(unit.second.begin(), unit.second.end(),
                          [&](const std::string& header) { return units.contains(header); });
    });
  }
  for (const auto& [unit, headers] : units) {
    ADD_FAILURE() << unit << " is in a circle, or leads into one";
  }
}

/// "Marker" of "struct Marker {" or "class Marker final : public Term {" at the start of a line, where
/// headers define the types of the namespace; empty of declarations and of all other lines.
std::string defined_type(const std::string& line) {
  static const std::regex definition(
      R"(^(?:struct|class|union|enum|enum class) (\w+)(?: final)?(?: : [^;]*)?(?: \{.*)?$)");
  std::smatch match;
  return std::regex_match(line, match, definition) ? match[1].str() : "";
}

/// Two types of one name are taken for one by the linker, which keeps one of the functions that
/// the compiler makes for both: a vector of the one then grows as a vector of the other.
TEST(Files, DefineEachTypeOnce) {
  std::map<std::string, std::string> places;
  for (const auto& [file, line] : read_lines()) {
    if (!file.ends_with(".hpp")) continue;
    const std::string type = defined_type(line);
    if (type.empty()) continue;
    const auto [place, is_new] = places.emplace(type, file);
    EXPECT_TRUE(is_new) << type << " is defined in " << place->second << " and in " << file;
  }
  EXPECT_GT(places.size(), 400U);
}

TEST(Files, OfLinesThatDefineTypesTheNamesAreFound) {
  EXPECT_EQ(defined_type("struct Marker {"), "Marker");
  EXPECT_EQ(defined_type("class JointTerm final : public Term {"), "JointTerm");
  EXPECT_EQ(defined_type("enum class Side { left, right };"), "Side");
  EXPECT_EQ(defined_type("class Term;"), "");
  EXPECT_EQ(defined_type("  struct Inner {"), "");
}

/// "text_of(double, int)" of "std::string text_of(double value, int digits = 5);" at the start of a line,
/// where headers declare the functions of the namespace; empty of all other lines.
std::string declared_function(const std::string& line) {
  static const std::regex declaration(
      R"(^(?:inline |constexpr )*(?!return |using |typedef )[A-Za-z][\w:<>&*, ]* (\w+)\(([^()]*)\) ?[;{].*$)");
  static const std::regex name_of_parameter(R"(( ?\w+)?( = [^,]*)?(,|$))");
  std::smatch match;
  if (!std::regex_match(line, match, declaration)) return "";
  return match[1].str() + "(" +
         std::regex_replace(match[2].str(), name_of_parameter, "$3",
                            std::regex_constants::format_default) +
         ")";
}

/// Two functions of one name and of the same parameters are taken for one, too: which of them is called
/// is left to the linker.
TEST(Files, DeclareEachFunctionOnce) {
  std::map<std::string, std::string> places;
  for (const auto& [file, line] : read_lines()) {
    if (!file.ends_with(".hpp")) continue;
    const std::string function = declared_function(line);
    if (function.empty()) continue;
    const auto [place, is_new] = places.emplace(function, file);
    EXPECT_TRUE(is_new || place->second == file)
        << function << " is in " << place->second << " and in " << file;
  }
  EXPECT_GT(places.size(), 400U);
}

TEST(Files, OfLinesThatDeclareFunctionsTheParametersAreFound) {
  EXPECT_EQ(declared_function("std::string text_of(double value, int digits = 5);"),
            "text_of(double, int)");
  EXPECT_EQ(declared_function("inline std::string text_of(double share) {"), "text_of(double)");
  EXPECT_EQ(declared_function("int count();"), "count()");
  EXPECT_EQ(declared_function("  int count() const;"), "");
  EXPECT_EQ(declared_function("return count();"), "");
}

/// The command's rooms: each knows those before it.
TEST(Rooms, OfTheCommandKnowOnlyThoseBefore) {
  const std::vector<std::string> rooms = {"cli/text",  "cli/input",    "cli/reports",
                                          "cli/files", "cli/commands", "cli"};
  const auto number = [&](const std::string& path) {
    return std::find(rooms.begin(), rooms.end(), fs::path(path).parent_path().generic_string()) -
           rooms.begin();
  };
  for (const auto& [file, folder, header] : read_includes()) {
    if (!file.starts_with("cli/") || !fs::exists(fs::path(pleuel::source_folder()) / header))
      continue;
    if (!header.starts_with("cli/")) continue;
    ASSERT_LT(number(file), std::ssize(rooms)) << file << " is in no room";
    EXPECT_LE(number(header), number(file)) << file << " includes " << header;
  }
}

/// A finding that nobody asks for is never told, whatever its own tests say.
TEST(Checks, AreAllAskedFor) {
  static const std::regex name("check_[a-z_]+");
  Names declared, used;
  for (const auto& [file, line] : read_lines()) {
    if (!file.starts_with("core/trust/")) continue;
    std::smatch found;
    if (!std::regex_search(line, found, name)) continue;
    if (file.ends_with(".hpp") && line.starts_with("std::vector<Finding> ")) {
      declared.insert(found.str());
    }
    if (!file.ends_with(".cpp") || line.starts_with("std::vector<Finding> check_")) continue;
    for (std::sregex_iterator at(line.begin(), line.end(), name), end; at != end; ++at) {
      used.insert(at->str());
    }
  }
  EXPECT_GT(declared.size(), 20u);
  for (const std::string& one : declared) EXPECT_TRUE(used.contains(one)) << one;
}

TEST(Floors, AreReadAtAll) {
  EXPECT_GT(read_includes().size(), 200U);
}

}  // namespace
}  // namespace pleuel::test::floors_test
