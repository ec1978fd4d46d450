#pragma once

#include <string>

/// Numbers for people.
namespace pleuel {

/// `digits` significant digits without exponent where that is readable: 25.130, 0.20000, 1.2e-07.
std::string significant(double value, int digits = 5);

/// The same with its sign: "+25.130", "−0.20000"; "0" for zero.
std::string signed_significant(double value, int digits = 5);

/// Two digits with exponent, for errors and residuals: 3.1e-08; "0" for zero.
std::string magnitude(double value);

/// "45.2 %"; from ten on "2397 times"
std::string percent(double fraction);

/// Two digits at most, and no exponent: "0.031 %", "5 %", "230 %".
std::string rough_percent(double share);

/// "+2.1 %", "−45.2 %", "0.0 %"
std::string signed_percent(double fraction);

/// "1.97 times as large", "larger by far" or "of the other sign"
std::string times_as_large(double ratio);

/// "0.083 s", "12.4 s", "3 min 20 s"
std::string duration(double seconds);

}  // namespace pleuel
