#pragma once

/// Values as bytes and back, for other processes of the same program on the same kind of machine:
/// doubles bit by bit. Plain structs go member by member, in their order and without a
/// list of their names, so that one that is added later goes, too; others say how, once for both ways:
///
///     template <class Archive>
///     void transfer(Archive& archive, Interval& interval) {
///       archive(interval.lower, interval.upper);
///     }
///
///     const Interval same = unpacked<Interval>(packed(interval));

#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

namespace pleuel {

namespace members {

/// They initialize any member, of a class and else, where nothing runs.
struct OfClass {
  template <class Member>
  requires std::is_class_v<Member>
  operator Member() const { std::abort(); }
};
struct OfPlainType {
  template <class Member>
  requires(!std::is_class_v<Member>) operator Member() const { std::abort(); }
};

/// As many as can be initialized.
template <class Struct, class... Known>
constexpr std::size_t count() {
  if constexpr (requires { Struct{Known()..., OfClass()}; }) {
    return count<Struct, Known..., OfClass>();
  } else if constexpr (requires { Struct{Known()..., OfPlainType()}; }) {
    return count<Struct, Known..., OfPlainType>();
  } else {
    return sizeof...(Known);
  }
}

}  // namespace members

inline constexpr std::size_t most_members = 26;

template <class Struct>
inline constexpr std::size_t member_count = members::count<Struct>();

/// Calls use(first, second, …) with all members of the struct.
/// @pre an aggregate without bases and arrays of C; more than `most_members` do not compile
template <class Struct, class Use>
decltype(auto) with_members(Struct& object, Use&& use) {
  constexpr std::size_t count = member_count<std::remove_const_t<Struct>>;
  static_assert(count > 0 && count <= most_members);
  if constexpr (count == 1) {
    auto& [a] = object;
    return use(a);
  } else if constexpr (count == 2) {
    auto& [a, b] = object;
    return use(a, b);
  } else if constexpr (count == 3) {
    auto& [a, b, c] = object;
    return use(a, b, c);
  } else if constexpr (count == 4) {
    auto& [a, b, c, d] = object;
    return use(a, b, c, d);
  } else if constexpr (count == 5) {
    auto& [a, b, c, d, e] = object;
    return use(a, b, c, d, e);
  } else if constexpr (count == 6) {
    auto& [a, b, c, d, e, f] = object;
    return use(a, b, c, d, e, f);
  } else if constexpr (count == 7) {
    auto& [a, b, c, d, e, f, g] = object;
    return use(a, b, c, d, e, f, g);
  } else if constexpr (count == 8) {
    auto& [a, b, c, d, e, f, g, h] = object;
    return use(a, b, c, d, e, f, g, h);
  } else if constexpr (count == 9) {
    auto& [a, b, c, d, e, f, g, h, i] = object;
    return use(a, b, c, d, e, f, g, h, i);
  } else if constexpr (count == 10) {
    auto& [a, b, c, d, e, f, g, h, i, j] = object;
    return use(a, b, c, d, e, f, g, h, i, j);
  } else if constexpr (count == 11) {
    auto& [a, b, c, d, e, f, g, h, i, j, k] = object;
    return use(a, b, c, d, e, f, g, h, i, j, k);
  } else if constexpr (count == 12) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l] = object;
    return use(a, b, c, d, e, f, g, h, i, j, k, l);
  } else if constexpr (count == 13) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = object;
    return use(a, b, c, d, e, f, g, h, i, j, k, l, m);
  } else if constexpr (count == 14) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n] = object;
    return use(a, b, c, d, e, f, g, h, i, j, k, l, m, n);
  } else if constexpr (count == 15) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o] = object;
    return use(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o);
  } else if constexpr (count == 16) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = object;
    return use(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p);
  } else if constexpr (count == 17) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q] = object;
    return use(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q);
  } else if constexpr (count == 18) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r] = object;
    return use(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r);
  } else if constexpr (count == 19) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s] = object;
    return use(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s);
  } else if constexpr (count == 20) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t] = object;
    return use(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t);
  } else if constexpr (count == 21) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u] = object;
    return use(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u);
  } else if constexpr (count == 22) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v] = object;
    return use(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v);
  } else if constexpr (count == 23) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w] = object;
    return use(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w);
  } else if constexpr (count == 24) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x] = object;
    return use(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x);
  } else if constexpr (count == 25) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y] = object;
    return use(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y);
  } else if constexpr (count == 26) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z] = object;
    return use(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z);
  }
}

/// Goes through values one by one, whichever way they go.
template <class Archive, class Value>
void pass(Archive& archive, Value& value) {
  if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>) {
    archive.raw(&value, sizeof value);
  } else if constexpr (requires { transfer(archive, value); }) {
    transfer(archive, value);
  } else {
    with_members(value, archive);
  }
}

/// Appends what it is called with to its bytes. Values are only read.
class Packer {
 public:
  static constexpr bool is_filling = false;

  template <class... Values>
  void operator()(Values&... values) {
    (pass(*this, values), ...);
  }
  void raw(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Fills what it is called with from bytes, in the order of packing.
class Unpacker {
 public:
  static constexpr bool is_filling = true;

  /// @param bytes  must outlive this
  explicit Unpacker(const std::string& bytes) : next_(bytes.data()), left_(bytes.size()) {}

  template <class... Values>
  void operator()(Values&... values) {
    (pass(*this, values), ...);
  }
  void raw(void* data, std::size_t size) {
    require(size, 1);
    if (size > 0) std::memcpy(data, next_, size);
    next_ += size;
    left_ -= size;
  }
  /// So many parts of so many bytes have to be there, before room is made for them.
  void require(std::size_t count, std::size_t bytes) const {
    if (count > left_ / bytes) throw std::runtime_error("packed values end too early");
  }

 private:
  const char* next_;
  std::size_t left_;
};

/// The size of a text or a list, which gets room for what is filled in.
template <class Archive, class List>
void transfer_size(Archive& archive, List& list) {
  std::size_t size = list.size();
  archive(size);
  if constexpr (Archive::is_filling) {
    archive.require(size, 1);
    list.resize(size);
  }
}

template <class Archive>
void transfer(Archive& archive, std::string& text) {
  transfer_size(archive, text);
  archive.raw(text.data(), text.size());
}

template <class Archive, class Value>
void transfer(Archive& archive, std::vector<Value>& values) {
  transfer_size(archive, values);
  for (Value& value : values) archive(value);
}

template <class Archive, class Value, std::size_t count>
void transfer(Archive& archive, std::array<Value, count>& values) {
  for (Value& value : values) archive(value);
}

template <class Archive, int Rows, int Columns>
void transfer(Archive& archive, Eigen::Matrix<double, Rows, Columns>& matrix) {
  Eigen::Index rows = matrix.rows(), columns = matrix.cols();
  archive(rows, columns);
  if constexpr (Archive::is_filling) {
    const std::size_t row = static_cast<std::size_t>(columns) * sizeof(double);
    if (rows > 0 && columns > 0) {
      archive.require(columns, sizeof(double));
      archive.require(rows, row);
    }
    matrix.resize(rows, columns);
  }
  archive.raw(matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof(double));
}

template <class Archive, class First, class Second>
void transfer(Archive& archive, std::pair<First, Second>& pair) {
  archive(pair.first, pair.second);
}

template <class Archive, class Key, class Value>
void transfer(Archive& archive, std::map<Key, Value>& values) {
  std::vector<std::pair<Key, Value>> entries(values.begin(), values.end());
  archive(entries);
  if constexpr (Archive::is_filling) values = {entries.begin(), entries.end()};
}

template <class Archive, class Value>
void transfer(Archive& archive, std::optional<Value>& value) {
  bool is_there = value.has_value();
  archive(is_there);
  if constexpr (Archive::is_filling) value = is_there ? std::optional(Value()) : std::nullopt;
  if (is_there) archive(*value);
}

template <class Archive, class Value>
void transfer(Archive& archive, std::shared_ptr<const Value>& value) {
  bool is_there = value != nullptr;
  archive(is_there);
  if constexpr (Archive::is_filling) value = is_there ? std::make_shared<Value>() : nullptr;
  if (is_there) archive(const_cast<Value&>(*value));
}

template <class Archive, class... Kinds>
void transfer(Archive& archive, std::variant<Kinds...>& value) {
  std::size_t index = value.index();
  archive(index);
  if constexpr (Archive::is_filling) {
    std::size_t i = 0;
    ((i++ == index ? void(value = Kinds()) : void()), ...);
    if (index >= i) throw std::runtime_error("packed values have an unknown kind");
  }
  std::visit(archive, value);
}

/// Of values that are not changed: packing only reads them.
template <class... Values>
std::string packed(const Values&... values) {
  Packer packer;
  packer(const_cast<Values&>(values)...);
  return packer.take();
}

/// @throws std::runtime_error if the bytes end too early
template <class... Values>
void unpack(const std::string& bytes, Values&... values) {
  Unpacker unpacker(bytes);
  unpacker(values...);
}

template <class Value>
Value unpacked(const std::string& bytes) {
  Value value;
  unpack(bytes, value);
  return value;
}

}  // namespace pleuel
