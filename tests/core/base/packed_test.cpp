#include "core/base/packed.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"

namespace pleuel::test::packed_test {
namespace {

enum class Colour { red, green };

struct Thing {
  std::string name;
  std::vector<std::optional<double>> numbers;
  Eigen::VectorXd vector;
  Eigen::MatrixXd matrix;
  std::map<std::pair<std::string, int>, Colour> colours;
  bool is_new = false;

  bool operator==(const Thing&) const = default;
};

TEST(Packed, ValuesComeBackBitByBit) {
  const Thing thing{"a\0b\n",
                    {0.1, std::nullopt, -0.0, 5e-324},
                    Eigen::Vector3d(1.0 / 3.0, std::numeric_limits<double>::infinity(), 1e308),
                    Eigen::MatrixXd::Random(2, 5),
                    {{{"rod", 3}, Colour::green}, {{"", 0}, Colour::red}},
                    true};
  const Thing same = unpacked<Thing>(packed(thing));
  EXPECT_EQ(same, thing);
  EXPECT_TRUE(std::signbit(*same.numbers[2]));
}

TEST(Packed, EmptyMatricesKeepTheirShape) {
  const Eigen::MatrixXd wide(0, 4);
  const auto same = unpacked<Eigen::MatrixXd>(packed(wide));
  EXPECT_EQ(same.rows(), 0);
  EXPECT_EQ(same.cols(), 4);
}

TEST(Packed, SizesBeyondTheBytesTakeNoMemory) {
  const std::uint64_t huge = std::uint64_t{1} << 60;
  const std::string size(reinterpret_cast<const char*>(&huge), sizeof huge);
  EXPECT_THROW(unpacked<std::string>(size), std::runtime_error);
  EXPECT_THROW(unpacked<Eigen::MatrixXd>(size + size), std::runtime_error);
  EXPECT_THROW(unpacked<Eigen::MatrixXd>(packed(std::uint64_t{1}) + size), std::runtime_error);
  EXPECT_THROW(unpacked<std::vector<double>>(size), std::runtime_error);
}

TEST(Packed, BytesThatEndTooEarlyAreAnError) {
  const std::string bytes = packed(std::string("words"), 1.0);
  std::string text;
  double number = 0.0;
  EXPECT_THROW(unpack(bytes.substr(0, bytes.size() - 1), text, number), std::runtime_error);
}

}  // namespace
}  // namespace pleuel::test::packed_test
