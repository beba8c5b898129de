/// Compressed values: they are read back exactly, and damage is detected.

#include <gtest/gtest.h>

#include <bit>
#include <filesystem>
#include <limits>
#include <random>

#include "common/errors.hpp"
#include "common/hdf5_io.hpp"
#include "mesher/temporary_folder.hpp"

namespace suffuse {
namespace hdf5_values_test {

using test::TemporaryFolder;

std::vector<double> noise(std::size_t count) {
  std::mt19937_64 random(1);
  std::vector<double> values(count);
  for (double& value : values) value = std::ldexp(static_cast<double>(random()), -64);
  return values;
}

/// Smooth, with zeros in every third place, as vectors of the plane have.
std::vector<double> vectors(std::size_t count) {
  std::vector<double> values(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    values[3 * i] = std::sin(1e-3 * static_cast<double>(i));
    values[3 * i + 1] = 1.0;
  }
  return values;
}

void expect_same_bits(const std::vector<double>& got, const std::vector<double>& wanted) {
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint64_t>(got[i]), std::bit_cast<std::uint64_t>(wanted[i])) << i;
  }
}

TEST(CompressedValues, KeepEveryBit) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.h5");
  // Several chunks, the last of which is not full.
  const std::size_t many = (std::size_t{1} << 19) + 1000;
  std::vector<double> odd = noise(100);
  odd[3] = std::numeric_limits<double>::quiet_NaN();
  odd[4] = -0.0;
  odd[5] = std::numeric_limits<double>::denorm_min();
  const std::vector<std::int64_t> offsets{-1, 0, std::numeric_limits<std::int64_t>::max()};
  const std::vector<float> rounded{1.5F, -0.25F};
  {
    Hdf5File file(path, Hdf5File::Mode::create);
    const auto write = [&](const std::string& name, const std::vector<double>& values,
                           const std::vector<std::size_t>& shape) {
      file.write_compressed(name, std::span(values), shape);
    };
    write("/odd", odd, {100});
    write("/one", {1.25}, {1});
    write("/none", {}, {0});
    write("/none_of_three", {}, {0, 3});
    write("/noise", noise(many), {many});
    write("/vectors", vectors(many), {many, 3});
    file.write_compressed("/offsets", std::span(offsets), {3});
    file.write_compressed("/rounded", std::span(rounded), {2});
    file.close();
  }
  const Hdf5File file(path, Hdf5File::Mode::read);
  expect_same_bits(file.read_doubles("/odd"), odd);
  expect_same_bits(file.read_doubles("/one"), {1.25});
  expect_same_bits(file.read_doubles("/none"), {});
  EXPECT_EQ(file.shape("/none_of_three"), (std::vector<std::size_t>{0, 3}));
  expect_same_bits(file.read_doubles("/noise"), noise(many));
  expect_same_bits(file.read_doubles("/vectors"), vectors(many));
  EXPECT_EQ(file.shape("/vectors"), (std::vector<std::size_t>{many, 3}));
  EXPECT_EQ(file.read_integers("/offsets"), offsets);
  expect_same_bits(file.read_doubles("/rounded"), {1.5, -0.25});
}

TEST(CompressedValues, TakeNoMoreRoomThanTheyHave) {
  const TemporaryFolder folder;
  const auto size_of = [&](const std::vector<double>& values,
                           const std::vector<std::size_t>& shape) {
    const std::string path = folder.file("a.h5");
    Hdf5File file(path, Hdf5File::Mode::create);
    file.write_compressed("/values", std::span(values), shape);
    file.close();
    return static_cast<double>(std::filesystem::file_size(path)) /
           static_cast<double>(sizeof(double) * values.size());
  };
  constexpr std::size_t count = 100000;
  EXPECT_LT(size_of(std::vector<double>(count, 0.3), {count}), 0.01);
  EXPECT_LT(size_of(vectors(count), {count, 3}), 0.29) << "one component of three";
  EXPECT_LT(size_of(noise(count), {count}), 1.01);
}

TEST(CompressedValues, AChangedByteIsSeen) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.h5");
  {
    Hdf5File file(path, Hdf5File::Mode::create);
    const std::vector<double> values = noise(1000);
    file.write_compressed("/values", std::span(values), {1000});
    file.close();
  }
  std::string bytes = test::read_file(path);
  for (const double place : {0.3, 0.5, 0.7}) {
    std::string damaged = bytes;
    const auto at = static_cast<std::size_t>(place * static_cast<double>(bytes.size()));
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    folder.write("a.h5", damaged);
    const Hdf5File file(path, Hdf5File::Mode::read);
    EXPECT_THROW(static_cast<void>(file.read_doubles("/values")), FileError) << place;
  }
}

}  // namespace hdf5_values_test
}  // namespace suffuse
