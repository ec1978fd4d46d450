#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "core/base/time_law.hpp"
#include "core/frame/body_frame.hpp"

/// The numbers of a joint or a force element in another scalar type.
///
/// Data is a struct template of scalars, vectors, lists of vectors and time laws. Its function
///     static void visit(function, data…)
/// calls function(member of each) for every member; then casting, seeding and differentiating need
/// not know the members.
namespace pleuel {

namespace data_detail {

/// to = function(from), number by number.
template <class To, class From, class Function>
void convert(To& to, const From& from, const Function& function) {
  to = function(from);
}
template <class To, class From, class Function>
void convert(Vector3<To>& to, const Vector3<From>& from, const Function& function) {
  for (int i = 0; i < 3; ++i) to(i) = function(from(i));
}
template <class To, class From, class Function>
void convert(std::vector<Vector3<To>>& to, const std::vector<Vector3<From>>& from,
             const Function& function) {
  to.resize(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) convert(to[i], from[i], function);
}
template <class To, class From, class Function>
void convert(TimeLaw<To>& to, const TimeLaw<From>& from, const Function& function) {
  to = from.template transformed<To>(function);
}

inline void seed(Dual& number, double derivative) {
  number.derivatives()[0] = derivative;
}
inline void seed(Vector3<Dual>& vector, const Vector3<double>& derivative) {
  for (int i = 0; i < 3; ++i) seed(vector(i), derivative(i));
}
inline void seed(std::vector<Vector3<Dual>>& vectors,
                 const std::vector<Vector3<double>>& derivatives) {
  for (std::size_t i = 0; i < vectors.size(); ++i) seed(vectors[i], derivatives[i]);
}
inline void seed(TimeLaw<Dual>& law, const TimeLaw<double>& derivative) {
  const std::size_t count = std::min(law.parameters.size(), derivative.parameters.size());
  for (std::size_t i = 0; i < count; ++i) seed(law.parameters[i], derivative.parameters[i]);
}

}  // namespace data_detail

template <class To, template <class> class Data, class From, class Function>
Data<To> convert_data(const Data<From>& from, const Function& function) {
  Data<To> to;
  Data<To>::visit(
      [&](auto& target, const auto& source) { data_detail::convert(target, source, function); }, to,
      from);
  return to;
}

/// The same numbers, with all derivatives zero.
template <class To, template <class> class Data>
Data<To> cast_data(const Data<double>& data) {
  return convert_data<To>(data, [](double number) { return To(number); });
}

/// Numbers with their derivatives. A time law without parameters has zero derivatives.
template <template <class> class Data>
Data<Dual> seed_data(const Data<double>& data, const Data<double>& derivative) {
  Data<Dual> seeded = cast_data<Dual>(data);
  Data<Dual>::visit([](auto& number, const auto& part) { data_detail::seed(number, part); }, seeded,
                    derivative);
  return seeded;
}

/// What seed_data() put in; nothing if all derivatives are zero.
template <template <class> class Data>
std::optional<Data<double>> derivative_data(const Data<Dual>& seeded) {
  bool is_zero = true;
  Data<double> derivative = convert_data<double>(seeded, [&](const Dual& number) {
    is_zero = is_zero && derivative_of(number) == 0.0;
    return derivative_of(number);
  });
  if (is_zero) return std::nullopt;
  return derivative;
}

}  // namespace pleuel
