#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/scene/body_constants.hpp"

namespace pleuel {

/// A design variable that the making of a body depends on.
struct MadeVariable {
  std::string name;
  std::string unit;  ///< SI
};

/// A program that makes a body for a design, as a problem file names it.
struct BodyProgram {
  std::string body;
  std::vector<std::string> command;
  std::string folder;  ///< that it runs in: that of the problem file
  std::vector<MadeVariable> variables;
  bool gives_derivatives = false;  ///< else they are forward differences of calls
  double step = 0.0;               ///< of these, relative
  double time_limit = 0.0;         ///< of a call [s]; 0: any time
  std::string record;              ///< folder that keeps what was made; empty: none
};

/// Makes an elastic body for a design, with derivatives. What it makes for two designs has the same
/// coordinates, places, points and elements.
class BodySource {
 public:
  virtual ~BodySource() = default;

  /// @param values  of the variables [SI], in their order
  /// @returns       InvariantsFile::design has these variables in this order
  /// @throws SimulationError if no body can be made for this design
  virtual std::shared_ptr<const InvariantsFile> at(const Eigen::VectorXd& values) const = 0;

  /// How far a design is from the nearest one that a body was made for, relative, if what it returns
  /// in between is continued; 0: every body is made for its design.
  virtual double distance(const Eigen::VectorXd& /*values*/) const { return 0.0; }

  /// The program behind it; null if it is no program.
  virtual const BodyProgram* program() const { return nullptr; }
};

/// A function of a design as a source: how other programs that use Pleuel as a library make bodies.
class BodyFunction : public BodySource {
 public:
  using Function = std::function<InvariantsFile(const Eigen::VectorXd& values)>;

  explicit BodyFunction(Function function) : function_(std::move(function)) {}

  std::shared_ptr<const InvariantsFile> at(const Eigen::VectorXd& values) const override {
    return std::make_shared<const InvariantsFile>(function_(values));
  }

 private:
  Function function_;
};

/// Calls the program once for each design, or once more for each variable where it gives no
/// derivatives, beside each other. What it made is kept, in memory and in the folder of the record.
/// @throws InputError from at() unless programs are allowed (core/base/child_program.hpp)
std::shared_ptr<const BodySource> make_program_source(BodyProgram program);

}  // namespace pleuel
