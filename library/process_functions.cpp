// What is of no problem: errors, the version, the request to stop, commands (include/pleuel.h).

#include <cstdlib>
#include <string>
#include <vector>

#include "cli/input/fingerprint.hpp"
#include "cli/input/run_setting.hpp"
#include "cli/program.hpp"
#include "core/base/stop.hpp"
#include "library/guarded_call.hpp"

namespace {

using namespace pleuel;

Outcome run_words(const std::vector<const char*>& words) {
  std::optional<Arguments> arguments =
      parse_arguments(static_cast<int>(words.size()), words.data());
  if (!arguments) return {};
  take_setting_of_run(*arguments);
  arguments->wants_json = true;
  return run_command(*arguments);
}

}  // namespace

const pleuel_error* pleuel_last_error(void) {
  return last_error();
}

const char* pleuel_version(void) {
  static const std::string text = version_text();
  return text.c_str();
}

void pleuel_stop(void) {
  request_stop();
}

void pleuel_free(char* text) {
  std::free(text);
}

pleuel_status pleuel_run(const char* const* words, size_t count, int* exit_code, char** document) {
  return guarded_call([&] {
    require_pointer(exit_code, "exit_code");
    require_pointer(document, "document");
    if (count > 0) require_pointer(words, "words");
    std::vector<const char*> all = {"pleuel"};
    for (size_t i = 0; i < count; ++i) {
      require_pointer(words[i], "words");
      all.push_back(words[i]);
    }
    const Outcome outcome = run_words(all);
    *document = text_out(to_text(outcome.document));
    *exit_code = outcome.final_code();
  });
}

int pleuel_main(int argc, const char* const* argv) {
  return run_program(argc, argv);
}
