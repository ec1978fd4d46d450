/* The library as a program in plain C sees it: only the header, other flags than the library has. */

#include "include/pleuel.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

static void expect(int holds, const char *what) {
  if (holds) return;
  printf("FAILED: %s; the last error: %s\n", what, pleuel_last_error()->text);
  ++failures;
}

/* Some milliseconds: the start of the motion, in coarse steps. */
static const char *const quick[] = {"/simulation/end_time=5 ms", "/simulation/step=0.1 ms"};

static pleuel_problem open_crank(const char *file) {
  pleuel_problem crank = 0;
  expect(pleuel_open(file, NULL, quick, 2, NULL, &crank) == PLEUEL_OK, "a problem opens");
  return crank;
}

static void names_are_those_of_the_file(pleuel_problem crank) {
  const char *name = "", *unit = "";
  size_t count = 0;
  expect(pleuel_count(crank, PLEUEL_VARIABLES, &count) == PLEUEL_OK && count == 4, "four variables");
  expect(pleuel_name(crank, PLEUEL_LIMITS, 1, &name) == PLEUEL_OK && strcmp(name, "rod_strength") == 0, "a limit");
  expect(pleuel_unit(crank, PLEUEL_LIMITS, 1, &unit) == PLEUEL_OK && strcmp(unit, "Pa") == 0, "its unit");
}

/* Central differences of the same function, of another step in each coordinate. */
static void jacobian_is_that_of_differences(pleuel_problem crank) {
  double x[4], objective, values[6], gradient[4], jacobian[6 * 4], above[6], below[6];
  expect(pleuel_bounds(crank, x, NULL, NULL, 4) == PLEUEL_OK, "the start is known");
  expect(pleuel_evaluate(crank, x, 4, &objective, values, 6, gradient, jacobian) == PLEUEL_OK, "it is evaluated");
  /* 7850 kg/m³ of 20 mm × 30 mm × (120 + 180) mm */
  expect(fabs(objective - 7850 * 0.02 * 0.03 * 0.3) < 1e-12, "its mass is density times volume");
  for (int j = 0; j < 4; ++j) {
    const double h = 1e-5 * x[j], kept = x[j];
    double other;
    x[j] = kept + h;
    expect(pleuel_evaluate(crank, x, 4, &other, above, 6, NULL, NULL) == PLEUEL_OK, "above");
    x[j] = kept - h;
    expect(pleuel_evaluate(crank, x, 4, &other, below, 6, NULL, NULL) == PLEUEL_OK, "below");
    x[j] = kept;
    for (int i = 0; i < 6; ++i) {
      const double slope = (above[i] - below[i]) / (2 * h), found = jacobian[4 * i + j];
      /* h² of the third derivative and round-off over h: some 1e-7 */
      expect(fabs(slope - found) <= 1e-5 * (fabs(slope) + fabs(values[i]) / x[j]), "an entry of the Jacobian");
    }
  }
}

static int stop_at_third(const pleuel_progress *progress, void *user) {
  *(int *)user = progress->evaluation;
  return progress->evaluation >= 3;
}

static void an_observer_ends_an_optimization(pleuel_problem crank) {
  char *result = NULL;
  int seen = 0;
  expect(pleuel_optimize(crank, NULL, 0, "{\"checks\": false}", stop_at_third, &seen, &result) == PLEUEL_OK,
         "what was found is returned");
  expect(seen == 3, "no evaluation follows");
  expect(result && strstr(result, "\"status\": \"interrupted\""), "the result says that it was ended");
  pleuel_free(result);
}

/* Counts its calls, and fails at the first. */
static int fail_at_once(const pleuel_search *search, double *y, char *reason, void *user) {
  double objective, rows[16];
  expect(pleuel_search_evaluate(search->number, y, search->variables, &objective, rows, 6, NULL, NULL) == PLEUEL_OK,
         "a search is evaluated at its start");
  ++*(int *)user;
  strcpy(reason, "no way down");
  return 1;
}

static void a_backend_that_fails_is_an_error(pleuel_problem crank) {
  char *result = NULL;
  int calls = 0;
  expect(pleuel_register_backend("mine", 0, fail_at_once, &calls) == PLEUEL_OK, "a backend is registered");
  expect(pleuel_optimize(crank, NULL, 0, "{\"backend\": \"mine\"}", NULL, NULL, &result) == PLEUEL_BAD_CALL,
         "a backend that fails");
  expect(calls == 1 && strstr(pleuel_last_error()->text, "no way down") != NULL, "its reason");
  expect(pleuel_register_backend("mine", 0, NULL, NULL) == PLEUEL_OK, "it is forgotten");
}

static void what_is_wrong_is_said(pleuel_problem crank) {
  double x[4] = {0.02, 0.03, NAN, 0.03}, objective, values[6];
  const char *const negative[] = {"/simulation/step=-1"};
  pleuel_problem other;
  const pleuel_error *error;
  expect(pleuel_evaluate(crank, x, 3, &objective, values, 6, NULL, NULL) == PLEUEL_BAD_CALL, "a wrong size");
  expect(pleuel_evaluate(crank, x, 4, &objective, values, 6, NULL, NULL) == PLEUEL_BAD_CALL, "a NaN");
  expect(strstr(pleuel_last_error()->text, "rod_width") != NULL, "the name of the variable");
  expect(pleuel_evaluate(crank, NULL, 4, &objective, values, 6, NULL, NULL) == PLEUEL_BAD_CALL, "a NULL");
  expect(pleuel_open("bad.json", "{\"name\": 3}", NULL, 0, NULL, &other) == PLEUEL_BAD_INPUT, "a bad text");
  expect(pleuel_open("missing.json", NULL, negative, 1, NULL, &other) == PLEUEL_BAD_INPUT, "a missing file");
  error = pleuel_last_error();
  expect(error->kind == PLEUEL_BAD_INPUT && strcmp(error->file, "missing.json") == 0, "the name of the file");
}

int main(int argc, char **argv) {
  if (argc != 2) return 2;
  const pleuel_problem crank = open_crank(argv[1]);
  names_are_those_of_the_file(crank);
  jacobian_is_that_of_differences(crank);
  an_observer_ends_an_optimization(crank);
  a_backend_that_fails_is_an_error(crank);
  what_is_wrong_is_said(crank);
  expect(pleuel_close(crank) == PLEUEL_OK, "it closes");
  expect(pleuel_close(crank) == PLEUEL_BAD_CALL, "once");
  printf("%s: %d failures\n", pleuel_version(), failures);
  return failures > 0;
}
