#pragma once

#include <memory>
#include <set>

#include "core/base/packed.hpp"
#include "core/scene/scene.hpp"

/// Every number of a struct of the scene that may be bound to a design variable. Members are gone through as they are
/// for packing: one that is added is visited, too, where a number that is left out would have no derivatives.
namespace pleuel {

/// Calls visit(number) for each number in the values that it goes through.
template <class Visit>
class NumberArchive {
 public:
  static constexpr bool is_filling = false;

  explicit NumberArchive(const Visit& visit) : visit_(visit) {}
  template <class... Values>
  void operator()(Values&... values) {
    (look_into(values), ...);
  }
  void raw(const void*, std::size_t) {}

 private:
  void look_into(Number& number) { visit_(std::as_const(number)); }
  void look_into(Drive& drive) { look_into(drive.motion); }  // it has constructors
  void look_into(Quantity&) {}
  template <class Shared>
  void look_into(std::shared_ptr<Shared>&) {}  // formulas, and bodies that are made
  template <class Value>
  void look_into(Value& value) {
    pass(*this, value);
  }

  const Visit& visit_;
};

template <class Object, class Visit>
void visit_numbers(const Object& object, const Visit& visit) {
  NumberArchive<Visit> archive(visit);
  archive(const_cast<Object&>(object));  // values are only read
}

/// Adds the design variables that numbers of an object depend on.
template <class Object>
void add_variables_of(const Object& object, std::set<int>& variables) {
  visit_numbers(object, [&](const Number& number) {
    for (const int variable : number.variables()) variables.insert(variable);
  });
}

}  // namespace pleuel
