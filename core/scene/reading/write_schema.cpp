#include <fstream>
#include <iostream>
#include <iterator>

#include "core/scene/reading/key_schema.hpp"

/// Writes into the schema of problem files what the tables of keys say:
///     problem_schema problems/problem.schema.json
int main(int count, char** arguments) {
  if (count != 2) {
    std::cerr << "one argument is needed: the file of the schema\n";
    return 2;
  }
  std::ifstream stream(arguments[1]);
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  std::ofstream(arguments[1]) << pleuel::schema_text(
      pleuel::with_tables(pleuel::Json::parse(text)));
  return 0;
}
