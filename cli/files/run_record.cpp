#include "cli/files/run_record.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "cli/files/older_run.hpp"
#include "cli/files/report_page.hpp"
#include "cli/text/wrapped_text.hpp"
#include "cli/versions.hpp"

namespace pleuel {

namespace {

Json input_document(const ProblemInput& input, const Arguments& arguments) {
  Json document = {
      {"file", input.file.string()}, {"overrides", arguments.overrides}, {"hash", input.hash}};
  if (arguments.design) document["design"] = arguments.design->string();
  return document;
}

}  // namespace

RunRecord::RunRecord(const Arguments& arguments, Json options)
    : folder_(arguments),
      program_(arguments.program),
      makes_report_(!arguments.leaves_out_report && arguments.command != "invariants") {
  card_["finished"] = false;
  card_["command"] = arguments.command;
  card_["arguments"] = arguments.words;
  card_["options"] = std::move(options);
  card_["versions"] = {{"pleuel", versions::pleuel},
                       {"nlopt", versions::nlopt},
                       {"ipopt", versions::ipopt},
                       {"eigen", versions::eigen},
                       {"klu", versions::klu},
                       {"compiler", versions::compiler},
                       {"build_type", versions::build_type}};
}

RunRecord::RunRecord(const Arguments& arguments, const ProblemInput& input, Json options)
    : RunRecord(arguments, std::move(options)) {
  card_["input"] = input_document(input, arguments);
  card_["problem"] = input.effective;
}

RunRecord::RunRecord(const Arguments& arguments, const std::vector<ProblemInput>& inputs,
                     Json options)
    : RunRecord(arguments, std::move(options)) {
  for (const ProblemInput& input : inputs) {
    card_["inputs"].push_back(input_document(input, arguments));
    card_["problems"].push_back(input.effective);
  }
}

void RunRecord::begin_phase(const std::string& name) {
  end_phase();
  phase_ = name;
  of_phase_ = {};
}

void RunRecord::end_phase() {
  if (!phase_.empty()) phases_[phase_] = phases_.value(phase_, 0.0) + of_phase_.seconds();
  phase_.clear();
}

ResultFile RunRecord::result(const fs::path& name) {
  if (!has_results_) replace_older_run();
  std::error_code error;  // shows when the file is written
  if (name.has_parent_path()) {
    fs::create_directory(folder() / name.parent_path(), error);
  }
  if (std::ranges::find(results_, name) == results_.end()) results_.push_back(name);
  return {folder() / name, &unwritten_};
}

void RunRecord::write(const std::string& name, const Json& document) {
  write_file(result(name), to_text(document));
}

void RunRecord::write_result(const Json& document) {
  write("result.json", versioned(document));
}

std::string RunRecord::files_text() const {
  std::vector<std::string> names;
  for (const fs::path& name : results_) {
    const bool is_lost =
        std::ranges::find(unwritten_, (folder() / name).string()) != unwritten_.end();
    if (!is_lost) names.push_back(name.string());
  }
  return wrapped(fmt::format("Written to {}: {}\n", folder().string(), fmt::join(names, ", ")),
                 "  ");
}

void RunRecord::finish(Outcome& outcome, const std::function<Json()>& make_picture) {
  end_phase();
  outcome.document = versioned(outcome.document);
  write_result(outcome.document);
  outcome.text += files_text();
  if (make_picture) show_picture(make_picture);
  write_report(outcome);
  phases_["total"] = total_.seconds();
  card_["finished"] = true;
  outcome.unwritten = unwritten_;
  card_["exit_code"] = outcome.final_code();
  card_["seconds"] = phases_;
  write(card_name, card_);
  outcome.unwritten = unwritten_;
}

void RunRecord::show_picture(const std::function<Json()>& make_picture) {
  if (!makes_report_ || !find_report_template()) return;
  begin_phase("report");
  picture_ = make_picture();
  end_phase();
}

void RunRecord::write_report(Outcome& outcome) {
  if (!makes_report_) return;
  if (!find_report_template()) {
    outcome.text += missing_template_text(program_, folder());
    return;
  }
  begin_phase("report");
  Json card = card_;
  card["finished"] = true;
  card["exit_code"] = outcome.final_code();
  card["seconds"] = phases_;
  card["seconds"]["total"] = total_.seconds();
  if (write_page(result(report_name), report_data(card, outcome.document, picture_, folder()))) {
    outcome.text += fmt::format("Report: {}\n", (folder() / report_name).string());
  }
  end_phase();
}

void RunRecord::replace_older_run() {
  has_results_ = true;
  write(card_name, card_);  // first: a folder without it would not be ours any more
  folder_.remove_older_results();
}

}  // namespace pleuel
