#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "core/scene/problem_reader.hpp"

namespace pleuel::test {
namespace {

const std::filesystem::path problems = std::filesystem::path(PLEUEL_SOURCE_DIR) / "problems";

nlohmann::json load(const std::filesystem::path& path) {
  std::ifstream stream(path);
  return nlohmann::json::parse(stream);
}

TEST(HardFiles, AreReadAndValidAndSayWhyTheyAreHard) {
  const nlohmann::json document = load(problems / "problem.schema.json");
  valijson::Schema schema;
  valijson::SchemaParser(valijson::SchemaParser::kDraft7)
      .populateSchema(valijson::adapters::NlohmannJsonAdapter(document), schema);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(problems / "hard")) {
    const nlohmann::json file = load(entry.path());
    valijson::Validator validator;
    EXPECT_TRUE(validator.validate(schema, valijson::adapters::NlohmannJsonAdapter(file), nullptr))
        << entry.path();
    EXPECT_GE(read_problem(entry.path()).description.size(), 80U) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 17) << "as many as docs/stability.md lists";
}

}  // namespace
}  // namespace pleuel::test
