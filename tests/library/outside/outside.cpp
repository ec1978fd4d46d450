// All of pleuel.hpp from a project that knows the installed files only.

#include <cmath>
#include <iostream>
#include <stdexcept>

#include <pleuel.hpp>

namespace {

int failures = 0;

void expect(bool holds, const char* what) {
  if (holds) return;
  std::cout << "FAILED: " << what << '\n';
  ++failures;
}

template <class Call>
pleuel_status status_of(const Call& call) {
  try {
    call();
  } catch (const pleuel::Error& error) {
    return error.kind;
  }
  return PLEUEL_OK;
}

}  // namespace

int main(int, char** argv) {
  pleuel::Problem opened(argv[1],
                         {{"/simulation/end_time", "5 ms"}, {"/simulation/step", "0.1 ms"}});
  const pleuel::Problem crank = std::move(opened);
  const pleuel::Numbers x = crank.start();
  expect(crank.names(PLEUEL_VARIABLES).size() == x.size(), "names of variables");
  expect(crank.lower()[0] < x[0] && x[0] < crank.upper()[0], "bounds");
  const auto found = crank.evaluate(x, pleuel::Derivatives::yes);
  // 7850 kg/m³ of 20 mm × 30 mm × (120 + 180) mm, and its derivative by the width of the crank
  expect(std::abs(found.objective - 7850 * 0.02 * 0.03 * 0.3) < 1e-12, "mass");
  expect(std::abs(found.gradient[0] - 7850 * 0.03 * 0.12) < 1e-9, "its derivative");
  expect(found.jacobian.size() == found.limits.size() * x.size(), "Jacobian");
  pleuel::Numbers jacobian;
  const pleuel::Numbers responses = crank.responses(x, &jacobian);
  expect(responses[0] == found.objective, "responses");
  const auto history = crank.history(x, 2, pleuel::Derivatives::yes);
  expect(history.time.size() == 51 && history.derivatives.size() == 51 * x.size(), "history");
  int seen = 0;
  const std::string result =
      crank.optimize(R"({"checks": false})", [&](const pleuel_progress& progress) {
        seen = progress.evaluation;
        return seen == 2;
      });
  expect(seen == 2 && result.find("interrupted") != std::string::npos, "observer");
  try {
    crank.optimize("{}", [](const pleuel_progress&) -> bool { throw std::out_of_range("mine"); });
    expect(false, "exceptions of observers come out");
  } catch (const std::out_of_range&) {
  }
  pleuel::register_backend("mine", [](const pleuel::Search& search) -> pleuel::Numbers {
    const auto e = search.evaluate(search.start(), pleuel::Derivatives::yes);
    expect(e.jacobian.size() == e.limits.size() * e.gradient.size(), "functions of a search");
    throw std::out_of_range("mine");
  });
  expect(status_of([&] { crank.optimize(R"({"backend": "mine"})"); }) == PLEUEL_BAD_CALL,
         "a backend that throws");
  expect(status_of([&] { crank.evaluate({1.0}); }) == PLEUEL_BAD_CALL, "a wrong size");
  expect(status_of([] { pleuel::Problem("missing.json"); }) == PLEUEL_BAD_INPUT, "a missing file");
  expect(status_of([&] { opened.start(); }) == PLEUEL_BAD_CALL, "what was moved from is closed");
  std::cout << pleuel::run({"backends"}).size() << " letters, " << failures << " failures\n";
  return failures;
}
