# cmake -D FOLDER=… -D FILE=… -P WriteCommit.cmake: writes which commit the folder holds, if the file says another.
set(commit "unknown")
execute_process(COMMAND git -C ${FOLDER} rev-parse --short=8 HEAD OUTPUT_VARIABLE found
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
if(status STREQUAL "0")
  set(commit ${found})
endif()
file(CONFIGURE OUTPUT ${FILE} CONTENT [[
#pragma once

namespace pleuel::versions {

inline constexpr const char* commit = "@commit@";

}  // namespace pleuel::versions
]] @ONLY)
