#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

/// Names with a load case behind them: `bow[fast]` in a formula, "bow [fast]" in a table.
namespace pleuel {

/// Of documents that the program makes: name and range of the load case that one is of. What is made
/// from several cases is left out where it is read (NumberReader::read_or_leave_out()).
inline constexpr const char* case_key = "$case";

/// A case in brackets behind a name.
struct CaseSuffix {
  std::string load_case;
  std::size_t end = 0;  ///< of the text, behind the bracket
};

/// The case in brackets that follows from here on, after blanks; none if there is no bracket, or it
/// is not closed.
std::optional<CaseSuffix> case_suffix(std::string_view text, std::size_t at);

/// "bow [fast]" of "bow[fast]" and "bow [ fast ]"; other names as they are.
std::string spaced_case(const std::string& name);

/// The name without its case, and the case; none of a name without.
struct NameInCase {
  std::string name, load_case;
};
std::optional<NameInCase> split_case(const std::string& name);

}  // namespace pleuel
