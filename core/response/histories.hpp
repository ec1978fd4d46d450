#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace pleuel {

/// Histories of responses, one each: channels × instants; empty for constants. Responses that observe
/// the same share one, and so do copies.
class Histories {
 public:
  std::size_t size() const { return all_.size(); }
  const Eigen::MatrixXd& operator[](std::size_t response) const { return *all_[response]; }
  void add(std::shared_ptr<const Eigen::MatrixXd> history) { all_.push_back(std::move(history)); }
  void set(std::size_t response, Eigen::MatrixXd history) {
    all_[response] = std::make_shared<const Eigen::MatrixXd>(std::move(history));
  }

 private:
  std::vector<std::shared_ptr<const Eigen::MatrixXd>> all_;
};

}  // namespace pleuel
