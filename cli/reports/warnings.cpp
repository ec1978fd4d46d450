#include "cli/reports/warnings.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cli/reports/document_table.hpp"
#include "cli/text/console.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/number_text.hpp"
#include "core/trust/checks.hpp"

namespace pleuel {

std::string warnings_text(const std::vector<std::string>& warnings, int consequences) {
  std::string text;
  for (std::size_t i = 0; i + consequences < warnings.size(); ++i) {
    text += wrapped("Warning: " + warnings[i], "  ") + "\n";
  }
  if (consequences == 0) return text;
  return text + fmt::format("  and {} that may follow from this (--all-warnings)\n",
                            consequences == 1 ? "one more" : fmt::format("{} more", consequences));
}

void show_warnings_before(const ProblemFile& problem) {
  show(stderr, warnings_text(texts_of(check_before(problem))));
}

void SharedWarnings::add(const std::vector<std::string>& warnings, const std::string& whose) {
  for (const std::string& warning : warnings) all_[warning].push_back(whose);
}

std::vector<std::string> SharedWarnings::sentences() const {
  std::vector<std::string> sentences;
  for (const auto& [warning, whose] : all_.items()) {
    sentences.push_back(
        fmt::format("{} ({})", warning, fmt::join(whose.get<std::vector<std::string>>(), ", ")));
  }
  return sentences;
}

void add_new(std::vector<std::string>& warnings, const std::vector<std::string>& more) {
  for (const std::string& warning : more) {
    const bool is_known = std::ranges::find(warnings, warning) != warnings.end();
    if (!is_known) warnings.push_back(warning);
  }
}

namespace {

Json part_document(const ErrorPart& part) {
  return part.is_resolved && std::isfinite(part.bound) ? Json(part.bound) : Json(nullptr);
}

/// "; with shear +0.8": what the model leaves out, where that is more than what is uncertain of the rest.
std::string left_out_text(const Json& error, const ShownUnit& unit) {
  std::string text;
  const Json left_out = error.value("left_out", Json::object());
  for (const auto& [name, effect] : left_out.items()) {
    const double change = effect.get<double>();
    if (!(std::abs(change) > number_at(error, "/total").value_or(HUGE_VAL))) continue;
    text += fmt::format("; with {} {}", words_of(name), signed_significant(unit.shown(change), 2));
  }
  return text;
}

}  // namespace

Json error_document(const std::optional<ErrorBar>& bar) {
  if (!bar) return nullptr;
  const bool is_known = bar->is_resolved() && std::isfinite(bar->bound());
  Json document = {{"total", is_known ? Json(bar->bound()) : Json(nullptr)},
                   {"step", part_document(bar->step)},
                   {"elements", part_document(bar->elements)},
                   {"newton", part_document(bar->newton)},
                   {"effects", part_document(bar->effects)},
                   {"change", is_known ? Json(bar->change()) : Json(nullptr)}};
  if (bar->order && std::isfinite(*bar->order)) document["order"] = *bar->order;
  if (!bar->left_out.empty()) document["left_out"] = bar->left_out;
  if (!bar->is_modelled) document["is_modelled"] = false;
  return document;
}

std::string error_text(const Json& error, const ShownUnit& unit) {
  if (error.is_null()) return "–";
  if (!error.value("is_modelled", true)) return "not modelled";
  if (!error.at("total").is_number()) return "not resolved";
  const double total = error["total"].get<double>();
  return (total == 0.0 ? "exact" : "± " + significant(unit.shown(total), 2)) +
         left_out_text(error, unit);
}

std::string error_sentence(const ErrorBar& bar, double value, const ShownUnit& unit) {
  if (!bar.is_modelled) return "not modelled";
  if (!bar.is_resolved()) return "not resolved by steps and elements";
  if (bar.bound() == 0.0) return "exact" + left_out_text(error_document(bar), unit);
  const auto shown = [&](double bound) {
    return bound == 0.0 ? "0" : significant(unit.shown(bound), 2);
  };
  std::string text = fmt::format("known to ± {} {}", shown(bar.bound()), unit.name);
  if (value != 0.0) {
    text += fmt::format(" ({} %)", significant(100.0 * bar.bound() / std::abs(value), 2));
  }
  text += fmt::format(": step {}, elements {}", shown(bar.step.bound), shown(bar.elements.bound));
  if (bar.newton.bound > 0.0) text += fmt::format(", Newton {}", shown(bar.newton.bound));
  if (bar.effects.bound > 0.0) text += fmt::format(", effects {}", shown(bar.effects.bound));
  return text + left_out_text(error_document(bar), unit);
}

}  // namespace pleuel
