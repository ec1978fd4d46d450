/**
 * Pleuel for other programs: a problem is opened, and evaluated, differentiated and optimized from outside.
 *
 *     pleuel_problem crank;
 *     if (pleuel_open("slider_crank.json", NULL, NULL, 0, NULL, &crank) != PLEUEL_OK) {
 *       puts(pleuel_last_error()->text);
 *     }
 *
 * All numbers are in SI units. Arrays belong to the caller and are contiguous; their sizes are passed and
 * checked, and matrices are row by row. Every function that can fail returns a pleuel_status; outputs are
 * written only where that is PLEUEL_OK. No argument makes a function crash that is a valid pointer or NULL.
 *
 * Any thread may call any function. Calls with different problems run at the same time; those with
 * one problem wait for each other, but for pleuel_optimize and pleuel_motion, which never wait.
 */
#ifndef PLEUEL_H
#define PLEUEL_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define PLEUEL_API __attribute__((visibility("default")))
#else
#define PLEUEL_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** How a call ended; the first five are the exit codes of the command, too. */
typedef enum pleuel_status {
  PLEUEL_OK = 0,
  PLEUEL_FAULT = 1,             /**< of Pleuel itself */
  PLEUEL_BAD_INPUT = 2,         /**< of the problem file, the overrides, the options or the command line */
  PLEUEL_SIMULATION_FAILED = 3, /**< this design cannot be simulated */
  PLEUEL_STOPPED = 4,           /**< by pleuel_stop; of a search: it is to end */
  PLEUEL_BAD_CALL = 5           /**< a wrong size, a NULL, a number that is not finite, a closed
                            problem, an observer that throws, a backend that fails */
} pleuel_status;

/** Why the last call of this thread failed. Texts are UTF-8, never NULL, and empty where they are not known. */
typedef struct pleuel_error {
  pleuel_status kind;
  const char *file;    /**< of the problem */
  const char *pointer; /**< JSON pointer to the place in it: "/scene/bodies/rod/length" */
  const char *rule;    /**< what must hold there, and the value that does not */
  const char *text;    /**< all of it, as the command would say it */
} pleuel_error;

/** @returns the error of this thread's last call that failed; valid until its next call that fails */
PLEUEL_API const pleuel_error *pleuel_last_error(void);

/** @returns "pleuel 0.1.0 (commit …, compiler, flags)" */
PLEUEL_API const char *pleuel_version(void);

/**
 * Asks all calls that run in this process now to end with PLEUEL_STOPPED, soon: an optimization ends with
 * what it found so far. Calls that begin afterwards, when those have ended, are not affected. May be called by handlers of
 * signals.
 */
PLEUEL_API void pleuel_stop(void);

/** Gives a text back that a function returned; NULL is nothing. */
PLEUEL_API void pleuel_free(char *text);

/* ---- problems ---- */

/** An open problem: a number that is never used again; 0 is none. */
typedef uint64_t pleuel_problem;

/**
 * Reads and checks a problem.
 * @param file       its name; of a text, how messages name it, and in whose folder other files are looked for
 * @param text       the problem as JSON; NULL: what the file contains
 * @param overrides  each "/json/pointer=value" or "variable=value", as of the command's --set; NULL if
 *                   there are none
 * @param load_case  the only one that is meant of a problem with several; NULL: all
 * @param problem    [out] to be closed by pleuel_close
 */
PLEUEL_API pleuel_status pleuel_open(const char *file, const char *text, const char *const *overrides,
                                     size_t override_count, const char *load_case,
                                     pleuel_problem *problem);

/** Calls that still work with it end as if it were open. */
PLEUEL_API pleuel_status pleuel_close(pleuel_problem problem);

/** What a problem has lists of: one of the numbers below. */
typedef int pleuel_list;
enum {
  PLEUEL_VARIABLES = 0, /**< of the design */
  PLEUEL_RESPONSES = 1, /**< of all load cases */
  PLEUEL_LIMITS = 2,    /**< of responses, or of sums of variables; of all load cases */
  PLEUEL_CASES = 3,
  PLEUEL_BODIES = 4,
  PLEUEL_JOINTS = 5,
  PLEUEL_OBJECTIVE = 6 /**< the response that is minimized or maximized; none or one */
};

/** @param count [out] how many of them the problem has */
PLEUEL_API pleuel_status pleuel_count(pleuel_problem problem, pleuel_list list, size_t *count);

/**
 * @param index  from 0
 * @param name   [out] valid until the problem is closed
 */
PLEUEL_API pleuel_status pleuel_name(pleuel_problem problem, pleuel_list list, size_t index,
                                     const char **name);

/**
 * The SI unit of the values of variables, responses, limits and the objective.
 * @param unit  [out] "m", "Pa"; empty for plain numbers; valid until the problem is closed
 */
PLEUEL_API pleuel_status pleuel_unit(pleuel_problem problem, pleuel_list list, size_t index,
                                     const char **unit);

/**
 * Start and bounds of the variables; any of the arrays may be NULL.
 * @param start, lower, upper  [out] one a variable; ±HUGE_VAL where there is no bound
 * @param variables            size of each array
 */
PLEUEL_API pleuel_status pleuel_bounds(pleuel_problem problem, double *start, double *lower,
                                       double *upper, size_t variables);

/** lower ≤ value ≤ upper of each limit, likewise. */
PLEUEL_API pleuel_status pleuel_limits(pleuel_problem problem, double *lower, double *upper,
                                       size_t limits);

/* ---- evaluation ---- */

/**
 * What an optimizer asks for at one design. Gradients are exact for the discrete motion, and cost no second
 * simulation of the design seen last.
 * @param x          design, one number a variable
 * @param objective  [out] what is minimized: the response, or its negative where that is maximized
 * @param values     [out] of the limited responses and sums, one a limit; NULL if there are none
 * @param gradient   [out] of the objective, one a variable; NULL: not asked for
 * @param jacobian   [out] limits × variables; NULL: not asked for
 */
PLEUEL_API pleuel_status pleuel_evaluate(pleuel_problem problem, const double *x, size_t variables,
                                         double *objective, double *values, size_t limits,
                                         double *gradient, double *jacobian);

/**
 * Values of all responses of all load cases.
 * @param values    [out] one a response
 * @param jacobian  [out] responses × variables; NULL: not asked for
 */
PLEUEL_API pleuel_status pleuel_responses(pleuel_problem problem, const double *x, size_t variables,
                                          double *values, size_t responses, double *jacobian);

/**
 * How many instants the history of a response has at a design; 0 if it has none (a mass).
 * The simulation is kept for pleuel_history.
 */
PLEUEL_API pleuel_status pleuel_history_size(pleuel_problem problem, const double *x,
                                             size_t variables, size_t response, size_t *instants);

/**
 * The history of a response: the largest value of all places at each instant, or, where derivatives are asked for,
 * that at the place of the peak.
 * @param time         [out] one an instant [s]
 * @param values       [out] one an instant
 * @param derivatives  [out] instants × variables; NULL: not asked for
 */
PLEUEL_API pleuel_status pleuel_history(pleuel_problem problem, const double *x, size_t variables,
                                        size_t response, double *time, double *values,
                                        size_t instants, double *derivatives);

/**
 * Geometry and motion of the mechanism at a design, as the report shows them (docs/report.md).
 * @param document  [out] JSON; to be given back by pleuel_free
 */
PLEUEL_API pleuel_status pleuel_motion(pleuel_problem problem, const double *x, size_t variables,
                                       char **document);

/**
 * Derivatives of all responses by each number of an elastic body of the type "invariants", as
 * `pleuel gradient --by-invariants` has them (docs/invariants.md): for finite-element programs that know how these numbers
 * depend on variables of their own.
 * @param body      its name
 * @param document  [out] JSON; to be given back by pleuel_free
 */
PLEUEL_API pleuel_status pleuel_by_invariants(pleuel_problem problem, const double *x,
                                              size_t variables, const char *body, char **document);

/* ---- optimization ---- */

/** One evaluation of an optimization. Its arrays are valid during the call only. */
typedef struct pleuel_progress {
  int evaluation;            /**< 1, 2, 3, … */
  int iteration;             /**< designs with gradients so far */
  size_t variables, limits;  /**< sizes of the arrays; no limits after a failure */
  const double *x;
  double objective;          /**< what is minimized */
  const double *values;      /**< of limits */
  double max_violation;      /**< relative; 0 or less: all limits are kept */
  const char *failure;       /**< why the design could not be simulated; empty: it could */
} pleuel_progress;

/**
 * Hears of each evaluation, on the thread of pleuel_optimize.
 * @returns 0 to go on; else the optimization ends with what it found so far
 */
typedef int (*pleuel_observer)(const pleuel_progress *progress, void *user);

/**
 * Optimizes the design, and proves or questions the answer, as `pleuel optimize` does.
 * @param x         where the search begins; NULL: the start of the problem
 * @param options   JSON object: "backend", "tolerance", "max_iterations", "starts", "jobs", "checks";
 *                  NULL: as the problem has them
 * @param observer  may be NULL
 * @param user      passed to the observer
 * @param result    [out] JSON as result.json of the command (docs/reference/commands.md), without simulations at the
 *                  optimum; its "status" says whether the optimum is verified. To be given back by pleuel_free
 */
PLEUEL_API pleuel_status pleuel_optimize(pleuel_problem problem, const double *x, size_t variables,
                                         const char *options, pleuel_observer observer, void *user,
                                         char **result);

/* ---- optimizers of the caller ---- */

/**
 * What a backend has to do, in numbers of order one:
 *
 *     minimize f(y)   subject to   g(y) <= 0,   h(y) = 0,   lower <= y <= upper
 *
 * Valid until the backend returns.
 */
typedef struct pleuel_search {
  uint64_t number;          /**< for pleuel_search_evaluate */
  size_t variables;         /**< those that may change */
  size_t inequalities;      /**< rows of g */
  size_t equalities;        /**< rows of h */
  const double *start, *lower, *upper; /**< one a variable; ±HUGE_VAL where there is no bound */
  double tolerance;         /**< relative, of f and y, at which it should end */
} pleuel_search;

/** Room for the text of a backend, with the 0 at its end. */
#define PLEUEL_REASON_SIZE 256

/**
 * An optimizer. What it finds is judged by Pleuel as the answers of other backends are: designs are remembered, so that
 * the best one counts wherever it ends.
 * @param y       [in, out] from search->start to where it ended, one a variable
 * @param reason  [out] may be filled with why it ended or failed, PLEUEL_REASON_SIZE bytes; empty at first
 * @returns       0; else it failed, and with it the call that needed it
 */
typedef int (*pleuel_backend)(const pleuel_search *search, double *y, char *reason, void *user);

/**
 * Makes an optimizer known to all problems of this process, under a name that "backend" of options, problem files and
 * commands may have. While one is known, searches from several starts run one after another in this process.
 * @param name              letters, digits, '-' and '_'; not one that Pleuel has; one that was registered is replaced
 * @param takes_equalities  whether it can keep h(y) = 0; else problems with such limits are refused
 * @param backend           NULL: forgets the one of this name
 * @param user              passed to the backend
 */
PLEUEL_API pleuel_status pleuel_register_backend(const char *name, int takes_equalities,
                                                 pleuel_backend backend, void *user);

/**
 * For backends: f, the rows of g and then those of h, and their derivatives at y, which is taken between its bounds.
 * @param search     number of a search
 * @param y          one a variable
 * @param objective  [out] f
 * @param rows       [out] of g, then of h; NULL if there are none
 * @param gradient   [out] of f, one a variable; NULL: not asked for
 * @param jacobian   [out] rows × variables; NULL: not asked for
 * @returns          PLEUEL_SIMULATION_FAILED: y has no values, and another should be tried; PLEUEL_STOPPED: the
 *                   backend should return now
 */
PLEUEL_API pleuel_status pleuel_search_evaluate(uint64_t search, const double *y, size_t variables,
                                                double *objective, double *rows, size_t row_count,
                                                double *gradient, double *jacobian);

/* ---- bodies that are made for each design ---- */

/**
 * Makes an elastic body for a design. May be called by any thread; calls for one problem one after the other. While
 * one is known, searches from several starts run one after another in this process.
 * @param values  of the variables that the generator of the body names, in their order
 * @param text    [out] a file of invariants (docs/invariants.md), valid until the next call; after a failure, why
 *                there is no body
 * @returns 0; else the design cannot be simulated, and the text is the reason
 */
typedef int (*pleuel_body_maker)(const double *values, size_t variables, const char **text,
                                 void *user);

/**
 * From now on, problems that are opened have their body of this name made by a function, in place of the program that
 * its "generator" may name.
 * @param make  used as long as such a problem is open; NULL: no function any more
 * @param user  passed to it
 */
PLEUEL_API pleuel_status pleuel_register_body(const char *body, pleuel_body_maker make, void *user);

/** @param allowed  whether problems that are opened from now on may run programs, as with --allow-programs; at first not */
PLEUEL_API pleuel_status pleuel_allow_programs(int allowed);

/* ---- commands ---- */

/**
 * Runs any command of the program. Lines of progress go to standard error.
 * @param words      the command line without the program: {"simulate", "slider_crank.json"}
 * @param exit_code  [out] of the command: 4 if it ended without a verified answer
 * @param document   [out] what the command prints with --json; to be given back by pleuel_free
 * @returns PLEUEL_OK where there is a document, whatever the exit code
 */
PLEUEL_API pleuel_status pleuel_run(const char *const *words, size_t count, int *exit_code,
                                    char **document);

/** The program itself: prints, and takes signals for requests to end. @returns its exit code */
PLEUEL_API int pleuel_main(int argc, const char *const *argv);

#ifdef __cplusplus
}
#endif

#endif
