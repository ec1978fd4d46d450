#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

/// The data that the program puts into pages.
namespace pleuel::test {

/// What stands between the tags of a page.
nlohmann::json data_of(const std::filesystem::path& page);

/// Numbers of a packed document, RFC 4648 and IEEE 754.
std::vector<float> unpacked(const nlohmann::json& packed);

/// The entry of a list that has this name. @throws std::runtime_error if there is none
const nlohmann::json& named(const nlohmann::json& list, const std::string& name);

}  // namespace pleuel::test
