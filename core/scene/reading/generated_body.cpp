#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "core/base/fingerprint.hpp"
#include "core/base/int_size.hpp"
#include "core/base/plain_file_name.hpp"
#include "core/jobs/child_program.hpp"
#include "core/jobs/parallel.hpp"
#include "core/scene/aligned_body.hpp"
#include "core/scene/body_source.hpp"
#include "core/scene/reading/json_text.hpp"

namespace pleuel {

namespace {

namespace fs = std::filesystem;

std::string content_of_file(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// What calls of one program returned, by their input: a folder, one file a call. Any number of threads and
/// processes may use it.
class CallRecord {
 public:
  /// Calls of another command, or with other contents of the files that it names, are others.
  explicit CallRecord(const BodyGenerator& generator) : folder_(generator.record) {
    std::vector<std::string> words = generator.command;
    words.insert(words.end(), generator.files.begin(), generator.files.end());
    for (const std::string& word : words) {
      identity_.add(word);
      const fs::path file = fs::path(generator.folder) / word;
      std::error_code error;
      if (fs::is_regular_file(file, error)) identity_.add(content_of_file(file));
    }
  }

  /// @returns what the call returned; empty if it is not known
  std::string find(const std::string& input) const {
    return folder_.empty() ? "" : content_of_file(path_of(input));
  }

  /// A folder that cannot be written to costs a call later, no more.
  /// Written beside it and renamed: nobody reads half of it.
  void keep(const std::string& input, const std::string& output) const {
    if (folder_.empty()) return;
    static std::atomic<int> count = 0;
    std::error_code error;
    fs::create_directories(folder_, error);
    const fs::path path = path_of(input);
    const fs::path draft = fmt::format("{}.{}.{}", path.string(), ::getpid(), count++);
    std::ofstream stream(draft, std::ios::binary);
    stream << output;
    stream.close();
    if (stream) fs::rename(draft, path, error);
  }

  /// Of the command and its files.
  std::string identity() const { return identity_.text(); }

 private:
  fs::path path_of(const std::string& input) const {
    Fingerprint fingerprint = identity_;
    fingerprint.add(input);
    return folder_ / (plain_file_name(fingerprint.text()) + ".json");
  }

  std::filesystem::path folder_;
  Fingerprint identity_;
};

using FilePointer = std::shared_ptr<const InvariantsFile>;

std::mutex registry_mutex;
std::map<std::string, BodyFunction> registered;

BodyFunction function_of(const std::string& body) {
  const std::lock_guard<std::mutex> lock(registry_mutex);
  const auto found = registered.find(body);
  return found == registered.end() ? BodyFunction() : found->second;
}

/// Makes bodies by calls of a program or a function.
class GeneratedBody : public BodySource {
 public:
  explicit GeneratedBody(BodyGenerator generator)
      : generator_(std::move(generator)),
        function_(function_of(generator_.body)),
        record_(generator_) {
    if (function_) return;
    if (generator_.command.empty()) {
      throw InputError(
          "needs a \"command\" that makes the body, or a function that is registered for it "
          "(pleuel_register_body of the library)");
    }
    if (may_start_programs()) return;
    throw InputError(fmt::format(
        "would run the program \"{}\" in the folder \"{}\"; if you trust it, let it run with "
        "--allow-programs",
        fmt::join(generator_.command, " "), generator_.folder));
  }

  std::string identity() const override {
    return function_ ? "function of " + generator_.body : record_.identity();
  }

  const BodyGenerator& program() const {
    if (!function_) return generator_;
    throw InputError(
        fmt::format("the body \"{}\" is made by a function of this process, which cannot be sent "
                    "to others",
                    generator_.body));
  }

  FilePointer at(const Eigen::VectorXd& values) const override {
    const std::vector<double> key(values.begin(), values.end());
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto known = made_.find(key);
    if (known != made_.end()) return known->second;
    const auto failed = failures_.find(key);
    if (failed != failures_.end()) throw SimulationError(failed->second);
    try {
      const FilePointer file = std::make_shared<const InvariantsFile>(make(values));
      if (!first_) first_ = file;
      return made_[key] = file;
    } catch (const SimulationError& failure) {
      failures_[key] = failure.what();
      throw;
    }
  }

 private:
  /// Where it is that something is wrong: who made it, for which design.
  [[noreturn]] void fail(const Eigen::VectorXd& values, const std::string& what) const {
    throw SimulationError(
        fmt::format("the {} of the body \"{}\" at the design {}: {}",
                    function_ ? std::string("function")
                              : fmt::format("program \"{}\"", fmt::join(generator_.command, " ")),
                    generator_.body, design_text(values), what));
  }

  std::string design_text(const Eigen::VectorXd& values) const {
    std::vector<std::string> parts;
    for (int i = 0; i < int_size(values); ++i) {
      parts.push_back(fmt::format("{} = {:.6g} {}", generator_.variables[i].name, values(i),
                                  generator_.variables[i].unit));
    }
    return fmt::format("{}", fmt::join(parts, ", "));
  }

  std::string input_of(const Eigen::VectorXd& values) const {
    Json document;
    document["body"] = generator_.body;
    document["variables"] = Json::object();
    for (int i = 0; i < int_size(values); ++i) {
      document["variables"][generator_.variables[i].name] = values(i);
    }
    return document.dump() + "\n";
  }

  InvariantsFile call(const Eigen::VectorXd& values) const {
    const std::string input = input_of(values);
    std::string output = function_ ? function_(values) : record_.find(input);
    const bool is_known = !output.empty();
    if (!is_known && !function_) {
      output = output_of({generator_.command, generator_.folder, generator_.time_limit}, input);
    }
    InvariantsFile file =
        read_invariants_text(output, function_ ? "its text" : "its standard output");
    if (!is_known && !function_) record_.keep(input, output);
    return file;
  }

  InvariantsFile made_by_call(const Eigen::VectorXd& values) const {
    try {
      return call(values);
    } catch (const InputError& error) {
      fail(values, fmt::format("{}; it must write a body file and nothing else", error.what()));
    } catch (const SimulationError& error) {
      fail(values, error.what());
    }
  }

  InvariantsFile make(const Eigen::VectorXd& values) const {
    InvariantsFile file =
        generator_.gives_derivatives ? with_given_derivatives(values) : with_differences(values);
    if (!first_) return file;
    const SparseMatrix t = alignment(values, *first_, file);
    file.coordinates = first_->coordinates;
    file.constants = in_coordinates(std::move(file.constants), t);
    if (file.surface) file.surface->displacement *= Eigen::MatrixXd(t);
    for (ConstantsDerivative& of : file.design) {
      of.derivative = in_coordinates(std::move(*of.derivative), t);
    }
    return file;
  }

  SparseMatrix alignment(const Eigen::VectorXd& values, const InvariantsFile& reference,
                         const InvariantsFile& file) const {
    try {
      return alignment_of(reference, file);
    } catch (const SimulationError& error) {
      fail(values, error.what());
    }
  }

  InvariantsFile with_differences(const Eigen::VectorXd& values) const {
    const int count = int_size(values);
    std::vector<Eigen::VectorXd> designs(count + 1, values);
    for (int i = 0; i < count; ++i) {
      const double size = values(i) != 0.0 ? std::abs(values(i)) : 1.0;
      designs[i + 1](i) += generator_.step * size;
    }
    std::vector<InvariantsFile> files(count + 1);
    for_each_in_parallel(count + 1, function_ ? 1 : available_threads(),
                         [&](int i) { files[i] = made_by_call(designs[i]); });
    InvariantsFile file = files.front();
    file.design.clear();
    for (int i = 0; i < count; ++i) {
      const double step = designs[i + 1](i) - values(i);
      BodyConstants derivative = zero_constants(file.constants);
      const SparseMatrix t = alignment(designs[i + 1], file, files[i + 1]);
      add_constants(derivative, 1.0 / step, in_coordinates(files[i + 1].constants, t));
      add_constants(derivative, -1.0 / step, file.constants);
      file.design.push_back({generator_.variables[i].name, values(i), generator_.variables[i].unit,
                             std::move(derivative)});
    }
    return file;
  }

  /// Its own derivatives, in the order of the variables.
  InvariantsFile with_given_derivatives(const Eigen::VectorXd& values) const {
    InvariantsFile file = made_by_call(values);
    std::vector<ConstantsDerivative> design;
    for (int i = 0; i < int_size(values); ++i) {
      const MadeVariable& variable = generator_.variables[i];
      const auto given = std::ranges::find_if(
          file.design, [&](const ConstantsDerivative& of) { return of.variable == variable.name; });
      if (given == file.design.end() || !given->derivative) {
        fail(values, fmt::format("it gives no derivatives with respect to \"{}\"; write them, or "
                                 "set \"derivatives\": \"differences\"",
                                 variable.name));
      }
      if (std::abs(given->value - values(i)) > 1e-9 * std::abs(values(i))) {
        fail(values, fmt::format("it wrote a body of {} = {:.9g}", variable.name, given->value));
      }
      design.push_back(std::move(*given));
    }
    file.design = std::move(design);
    return file;
  }

  BodyGenerator generator_;
  BodyFunction function_;
  CallRecord record_;
  mutable std::mutex mutex_;
  mutable std::map<std::vector<double>, FilePointer> made_;
  mutable std::map<std::vector<double>, std::string> failures_;
  mutable FilePointer first_;
};

}  // namespace

void register_body(const std::string& body, BodyFunction function) {
  const std::lock_guard<std::mutex> lock(registry_mutex);
  if (function) {
    registered[body] = std::move(function);
  } else {
    registered.erase(body);
  }
}

std::shared_ptr<const BodySource> make_body_source(BodyGenerator generator) {
  return std::make_shared<const GeneratedBody>(std::move(generator));
}

const BodyGenerator& program_behind(const BodySource& source) {
  const auto* generated = dynamic_cast<const GeneratedBody*>(&source);
  if (generated) return generated->program();
  throw InputError("a body that is continued between designs cannot be sent to other processes");
}

}  // namespace pleuel
