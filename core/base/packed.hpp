#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
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

#include "core/base/members.hpp"

/// Values as bytes and back, for other processes of the same program on the same kind of machine:
/// doubles bit by bit. Plain structs go member by member (core/base/members.hpp); others say how:
///
///     template <class Archive>
///     void transfer(Archive& archive, Interval& interval) {
///       archive(interval.lower, interval.upper);
///     }
///
///     const Interval same = unpacked<Interval>(packed(interval));
namespace pleuel {

/// Appends what it is called with to its bytes.
class Packer {
 public:
  template <class... Values>
  void operator()(Values&... values) {
    (one(values), ...);
  }
  std::string take() { return std::move(bytes_); }

 private:
  template <class Value>
  void one(Value& value) {
    if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>) {
      raw(&value, sizeof value);
    } else if constexpr (requires { transfer(*this, value); }) {
      transfer(*this, value);
    } else {
      with_members(value, *this);
    }
  }
  void raw(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }
  friend void transfer(Packer& archive, std::string& text) {
    archive.size(text.size());
    archive.raw(text.data(), text.size());
  }
  template <int Rows, int Columns>
  friend void transfer(Packer& archive, Eigen::Matrix<double, Rows, Columns>& matrix) {
    archive.size(static_cast<std::size_t>(matrix.rows()));
    archive.size(static_cast<std::size_t>(matrix.cols()));
    archive.raw(matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof(double));
  }
  template <class Value>
  friend void transfer(Packer& archive, std::vector<Value>& values) {
    archive.size(values.size());
    for (Value& value : values) archive(value);
  }
  template <class Value>
  friend void transfer(Packer& archive, std::optional<Value>& value) {
    bool is_there = value.has_value();
    archive(is_there);
    if (is_there) archive(*value);
  }
  template <class Value>
  friend void transfer(Packer& archive, std::shared_ptr<const Value>& value) {
    bool is_there = value != nullptr;
    archive(is_there);
    if (is_there) archive(const_cast<Value&>(*value));  // only read
  }
  template <class Value, std::size_t count>
  friend void transfer(Packer& archive, std::array<Value, count>& values) {
    for (Value& value : values) archive(value);
  }
  template <class... Kinds>
  friend void transfer(Packer& archive, std::variant<Kinds...>& value) {
    archive.size(value.index());
    std::visit([&](auto& kind) { archive(kind); }, value);
  }
  template <class Key, class Value>
  friend void transfer(Packer& archive, std::map<Key, Value>& values) {
    archive.size(values.size());
    for (auto& [key, value] : values) {
      Key copy = key;
      archive(copy, value);
    }
  }
  void size(std::size_t size) {
    std::uint64_t number = size;
    raw(&number, sizeof number);
  }

  std::string bytes_;
};

/// Fills what it is called with from bytes, in the order of packing.
class Unpacker {
 public:
  /// @param bytes  must outlive this
  explicit Unpacker(const std::string& bytes) : next_(bytes.data()), left_(bytes.size()) {}

  template <class... Values>
  void operator()(Values&... values) {
    (one(values), ...);
  }

 private:
  template <class Value>
  void one(Value& value) {
    if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>) {
      raw(&value, sizeof value);
    } else if constexpr (requires { transfer(*this, value); }) {
      transfer(*this, value);
    } else {
      with_members(value, *this);
    }
  }
  /// So many parts of so many bytes have to be there, before room is made for them.
  void require(std::size_t count, std::size_t bytes) const {
    if (count > left_ / bytes) throw std::runtime_error("packed values end too early");
  }
  void raw(void* data, std::size_t size) {
    require(size, 1);
    if (size > 0) std::memcpy(data, next_, size);
    next_ += size;
    left_ -= size;
  }
  friend void transfer(Unpacker& archive, std::string& text) {
    const std::size_t size = archive.size();
    archive.require(size, 1);
    text.resize(size);
    archive.raw(text.data(), text.size());
  }
  template <int Rows, int Columns>
  friend void transfer(Unpacker& archive, Eigen::Matrix<double, Rows, Columns>& matrix) {
    const std::size_t rows = archive.size(), columns = archive.size();
    if (rows > 0 && columns > 0) {
      archive.require(columns, sizeof(double));
      archive.require(rows, columns * sizeof(double));
    }
    matrix.resize(rows, columns);
    archive.raw(matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof(double));
  }
  template <class Value>
  friend void transfer(Unpacker& archive, std::vector<Value>& values) {
    values.clear();
    for (std::size_t count = archive.size(); count > 0; --count) {
      archive(values.emplace_back());
    }
  }
  template <class Value>
  friend void transfer(Unpacker& archive, std::optional<Value>& value) {
    bool is_there = false;
    archive(is_there);
    value.reset();
    if (is_there) archive(value.emplace());
  }
  template <class Value>
  friend void transfer(Unpacker& archive, std::shared_ptr<const Value>& value) {
    bool is_there = false;
    archive(is_there);
    value.reset();
    if (!is_there) return;
    const auto made = std::make_shared<Value>();
    archive(*made);
    value = made;
  }
  template <class Value, std::size_t count>
  friend void transfer(Unpacker& archive, std::array<Value, count>& values) {
    for (Value& value : values) archive(value);
  }
  template <class... Kinds>
  friend void transfer(Unpacker& archive, std::variant<Kinds...>& value) {
    const std::size_t index = archive.size();
    std::size_t i = 0;
    const auto take = [&]<class Kind>(Kind kind) {
      if (i++ != index) return;
      archive(kind);
      value = std::move(kind);
    };
    (take(Kinds()), ...);
    if (index >= sizeof...(Kinds)) throw std::runtime_error("packed values have an unknown kind");
  }
  template <class Key, class Value>
  friend void transfer(Unpacker& archive, std::map<Key, Value>& values) {
    values.clear();
    for (std::size_t count = archive.size(); count > 0; --count) {
      Key key;
      archive(key);
      archive(values[std::move(key)]);
    }
  }
  std::size_t size() {
    std::uint64_t number = 0;
    raw(&number, sizeof number);
    return static_cast<std::size_t>(number);
  }

  const char* next_;
  std::size_t left_;
};

template <class Archive, class First, class Second>
void transfer(Archive& archive, std::pair<First, Second>& pair) {
  archive(pair.first, pair.second);
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
