#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "cli/input/arguments.hpp"

/// Options that several commands have.
namespace pleuel {

void add_overrides(CLI::App* command, Arguments& arguments);
/// Part of add_overrides().
void add_programs(CLI::App* command, Arguments& arguments);
void add_case(CLI::App* command, Arguments& arguments);
void add_overwrite(CLI::App* command, Arguments& arguments);
void add_resume(CLI::App* command, Arguments& arguments);
void add_no_report(CLI::App* command, Arguments& arguments);
CLI::Option* add_output(CLI::App* command, Arguments& arguments);
void add_design(CLI::App* command, Arguments& arguments);
void add_all_warnings(CLI::App* command, Arguments& arguments);
/// What is looked at besides the simulation.
void add_checks(CLI::App* command, Arguments& arguments);
void add_effects(CLI::App* command, Arguments& arguments);
/// @param what  it prints beside the answer
void add_verbose(CLI::App* command, Arguments& arguments, const std::string& what);
void add_accuracy(CLI::App* command, Arguments& arguments);
void add_backend(CLI::App* command, Arguments& arguments);
void add_starts(CLI::App* command, Arguments& arguments);
/// Of the gradients of an optimizer: one.
void add_method(CLI::App* command, Arguments& arguments);
void add_jobs(CLI::App* command, Arguments& arguments);
void add_task_limit(CLI::App* command, Arguments& arguments, const std::string& task);

}  // namespace pleuel
