#pragma once

/// Takes the place of the compiler's question for instructions.
extern "C" int old_processor_supports(const char* instructions);
