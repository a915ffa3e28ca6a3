// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/packed_array.h"
#include "common/support/units.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mmm_converter {
namespace {

TEST(PackedArray, Base64IsThatOfRfc4648) {
  EXPECT_EQ(EncodeBase64(""), "");
  EXPECT_EQ(EncodeBase64("f"), "Zg==");
  EXPECT_EQ(EncodeBase64("fo"), "Zm8=");
  EXPECT_EQ(EncodeBase64("foo"), "Zm9v");
  EXPECT_EQ(EncodeBase64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(EncodeBase64("\xff\xfe\x80"), "//6A");
}

TEST(PackedArray, FloatsAreLittleEndianColumnByColumn) {
  const Eigen::Matrix2d numbers{{1, 0}, {-2, 0}};
  const PackedArray packed = PackFloats(numbers);
  EXPECT_EQ(packed.type, "f32");
  const std::string bytes{"\x00\x00\x80\x3f\x00\x00\x00\xc0\0\0\0\0\0\0\0\0", 16};
  EXPECT_EQ(packed.base64, EncodeBase64(bytes));
}

TEST(PackedArray, QuantisedNumbersUseTheWholeRange) {
  const Eigen::Vector4d numbers(-1, 2, kNaN, 0.5);
  const PackedArray packed = PackQuantised(numbers);
  EXPECT_EQ(packed.type, "u16");
  EXPECT_DOUBLE_EQ(packed.offset, -1);
  EXPECT_DOUBLE_EQ(packed.scale, 3.0 / 65534);
  // -1 is 0, 2 is 65534, NaN is 65535, 0.5 lies in the middle: 32767.
  EXPECT_EQ(packed.base64, EncodeBase64(std::string{"\x00\x00\xfe\xff\xff\xff\xff\x7f", 8}));
}

TEST(PackedArray, EqualNumbersAndNoneAreNoDivisionByZero) {
  const PackedArray equal = PackQuantised(Eigen::Vector2d(0.25, 0.25));
  EXPECT_EQ(equal.offset, 0.25);
  EXPECT_EQ(equal.scale, 1);
  EXPECT_EQ(equal.base64, EncodeBase64(std::string(4, '\0')));
  const PackedArray none = PackQuantised(Eigen::VectorXd::Constant(1, kNaN));
  EXPECT_EQ(none.base64, EncodeBase64("\xff\xff"));
  EXPECT_EQ(PackQuantised(Eigen::VectorXd()).base64, "");
}

TEST(PackedArray, BitsStartAtTheLowest) {
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> bits(5, 2);
  bits.setConstant(false);
  bits(0, 0) = bits(3, 0) = bits(4, 1) = true;  // bits 0, 3 and 9
  EXPECT_EQ(PackBits(bits).base64, EncodeBase64("\x09\x02"));
}

}  // namespace
}  // namespace mmm_converter
