#pragma once

#include <cstdio>
#include <string>

/// Standard output and standard error, which may be closed, full, or a pipe that nobody reads.
namespace pleuel {

/// Opens /dev/null in place of standard streams that are closed, so that no file of ours takes
/// their number and their text, and turns signals of failed writing into errors of that writing.
void prepare_streams();

/// The text with colours of verdicts, broken limits and warnings (ECMA-48).
std::string coloured(const std::string& text);

/// The same where `out` is a terminal and NO_COLOR is not set; else the text.
std::string coloured_for(std::FILE* out, const std::string& text);

/// Shows progress, at once, in colours on a terminal. What cannot be written is
/// left out: the work is worth more.
void show(std::FILE* out, const std::string& text);

/// @returns why the text could not be written as a whole; empty if it could. A pipe that nobody
///          reads any more is no failure.
std::string write_all(std::FILE* out, const std::string& text);

}  // namespace pleuel
