#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "core/base/child_program.hpp"
#include "core/base/error.hpp"
#include "core/base/fingerprint.hpp"
#include "core/base/int_size.hpp"
#include "core/base/parallel.hpp"
#include "core/base/plain_file_name.hpp"
#include "core/scene/aligned_body.hpp"
#include "core/scene/body_source.hpp"
#include "core/scene/invariants_file.hpp"
#include "core/scene/reading/json_text.hpp"

namespace pleuel {

namespace {

namespace fs = std::filesystem;
using Values = std::vector<double>;
using FilePointer = std::shared_ptr<const InvariantsFile>;

std::string content_of_file(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// What calls of one program returned, by their input: in memory, and in a folder, one file a call.
class CallRecord {
 public:
  explicit CallRecord(const BodyProgram& program) : folder_(program.record) {
    for (const std::string& word : program.command) {
      identity_.add(word);
      const fs::path file = fs::path(program.folder) / word;
      std::error_code error;
      if (fs::is_regular_file(file, error)) identity_.add(content_of_file(file));
    }
  }

  std::string find(const std::string& input) const {
    return folder_.empty() ? "" : content_of_file(path_of(input));
  }

  /// Written beside it and renamed: nobody reads half of it. A folder that cannot be written to costs a
  /// call later, no more.
  void add(const std::string& input, const std::string& output) const {
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

 private:
  fs::path path_of(const std::string& input) const {
    Fingerprint fingerprint = identity_;
    fingerprint.add(input);
    return folder_ / (plain_file_name(fingerprint.text()) + ".json");
  }

  fs::path folder_;
  Fingerprint identity_;
};

class ProgramSource : public BodySource {
 public:
  explicit ProgramSource(BodyProgram program) : program_(std::move(program)), record_(program_) {}

  const BodyProgram* program() const override { return &program_; }

  FilePointer at(const Eigen::VectorXd& values) const override {
    const Values key(values.begin(), values.end());
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto known = made_.find(key);
    if (known != made_.end()) return known->second;
    const FilePointer file = std::make_shared<const InvariantsFile>(make(values));
    if (!first_) first_ = file;
    made_[key] = file;
    return file;
  }

 private:
  /// Where it is that something is wrong: the command with its design.
  [[noreturn]] void fail(const Eigen::VectorXd& values, const std::string& what) const {
    throw SimulationError(fmt::format("the program of the body \"{}\" ({}) at the design {}: {}",
                                      program_.body, fmt::join(program_.command, " "),
                                      design_text(values), what));
  }

  std::string design_text(const Eigen::VectorXd& values) const {
    std::vector<std::string> parts;
    for (int i = 0; i < int_size(values); ++i) {
      parts.push_back(fmt::format("{} = {:.6g} {}", program_.variables[i].name, values(i),
                                  program_.variables[i].unit));
    }
    return fmt::format("{}", fmt::join(parts, ", "));
  }

  std::string input_of(const Eigen::VectorXd& values) const {
    Json document;
    document["body"] = program_.body;
    document["variables"] = Json::object();
    for (int i = 0; i < int_size(values); ++i) {
      document["variables"][program_.variables[i].name] = values(i);
    }
    return document.dump() + "\n";
  }

  InvariantsFile call(const Eigen::VectorXd& values) const {
    const std::string input = input_of(values);
    std::string output = record_.find(input);
    const bool is_known = !output.empty();
    try {
      if (!is_known) {
        output = output_of({program_.command, program_.folder, program_.time_limit}, input);
      }
      InvariantsFile file = read_invariants_text(output, "its standard output");
      if (!is_known) record_.add(input, output);
      return file;
    } catch (const InputError& error) {
      fail(values, fmt::format("{}; it must write a body file and nothing else", error.what()));
    } catch (const SimulationError& error) {
      fail(values, error.what());
    }
  }

  InvariantsFile make(const Eigen::VectorXd& values) const {
    if (!may_start_programs()) {
      throw InputError(fmt::format(
          "the body \"{}\" is made by a program that the problem file names: \"{}\", in the folder "
          "\"{}\"; if you trust it, let it run with --allow-programs",
          program_.body, fmt::join(program_.command, " "), program_.folder));
    }
    InvariantsFile file =
        program_.gives_derivatives ? with_given_derivatives(values) : with_differences(values);
    if (!first_) return file;
    const SparseMatrix t = alignment(values, *first_, file);
    file.constants = in_coordinates(std::move(file.constants), t);
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
      designs[i + 1](i) += program_.step * size;
    }
    std::vector<InvariantsFile> files(count + 1);
    for_each_in_parallel(count + 1, available_threads(),
                         [&](int i) { files[i] = call(designs[i]); });
    InvariantsFile file = files.front();
    file.design.clear();
    for (int i = 0; i < count; ++i) {
      const double step = designs[i + 1](i) - values(i);
      BodyConstants derivative = zero_constants(file.constants);
      const SparseMatrix t = alignment(designs[i + 1], file, files[i + 1]);
      add_constants(derivative, 1.0 / step, in_coordinates(files[i + 1].constants, t));
      add_constants(derivative, -1.0 / step, file.constants);
      file.design.push_back({program_.variables[i].name, values(i), program_.variables[i].unit,
                             std::move(derivative)});
    }
    return file;
  }

  /// The program's own derivatives, in the order of the variables.
  InvariantsFile with_given_derivatives(const Eigen::VectorXd& values) const {
    InvariantsFile file = call(values);
    std::vector<ConstantsDerivative> design;
    for (int i = 0; i < int_size(values); ++i) {
      const MadeVariable& variable = program_.variables[i];
      const auto given =
          std::find_if(file.design.begin(), file.design.end(),
                       [&](const ConstantsDerivative& of) { return of.variable == variable.name; });
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

  BodyProgram program_;
  CallRecord record_;
  mutable std::mutex mutex_;
  mutable std::map<Values, FilePointer> made_;
  mutable FilePointer first_;
};

}  // namespace

std::shared_ptr<const BodySource> make_program_source(BodyProgram program) {
  return std::make_shared<const ProgramSource>(std::move(program));
}

}  // namespace pleuel
