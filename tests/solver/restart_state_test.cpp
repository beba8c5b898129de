/// The parts of a resumed run: the state as bytes, restart points, tables that are cut, the lock of
/// a folder.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <limits>

#include "files/layout.hpp"
#include "mesher/temporary_folder.hpp"
#include "results/state_archive.hpp"
#include "results/writer.hpp"

namespace suffuse {
namespace restart_state_test {

namespace fs = std::filesystem;
using test::read_file;
using test::TemporaryFolder;

std::string failure(const auto& body) {
  try {
    body();
  } catch (const FileError& error) {
    return error.what();
  }
  return "no FileError";
}

const std::string misfit = "the state of the run does not fit this program and case";

struct Pair {
  static constexpr bool has_no_gaps = true;
  double a = 0.0;
  std::int64_t b = 0;
};

/// One value of every kind that an archive accepts.
struct Everything {
  bool yes = false;
  int number = 0;
  double value = 0.0;
  std::string text;
  std::vector<double> values;
  std::vector<std::vector<int>> lists;
  std::vector<bool> flags;
  std::array<double, 2> array{};
  Eigen::Vector2d vector = Eigen::Vector2d::Zero();
  Eigen::VectorXd column;
  std::vector<Eigen::Vector2d> vectors;
  std::optional<Pair> pair;
  std::optional<std::string> none = "something";
  std::vector<Pair> pairs;

  void archive(StateArchive& archive) {
    archive(yes, number, value, text, values, lists, flags, array, vector, column, vectors, pair,
            none, pairs);
  }
};

std::vector<std::uint8_t> bytes_of(Everything& all) {
  StateArchive archive;
  archive(all);
  return archive.finish();
}

Everything example() {
  Everything all;
  all.yes = true;
  all.number = -7;
  all.value = -std::numeric_limits<double>::denorm_min();
  all.text = std::string("a\0b", 3);
  all.values = {1.0, -0.0, std::numeric_limits<double>::quiet_NaN()};
  all.lists = {{}, {1, 2, 3}};
  all.flags = {true, false, true};
  all.array = {3.0, 4.0};
  all.vector = {5.0, 6.0};
  all.column = Eigen::VectorXd::LinSpaced(5, 0.0, 1.0);
  all.vectors = {{7.0, 8.0}, {9.0, 10.0}};
  all.pair = Pair{11.0, 12};
  all.none.reset();
  all.pairs = {{13.0, 14}};
  return all;
}

TEST(StateArchive, GivesBackEveryBit) {
  Everything all = example();
  const std::vector<std::uint8_t> bytes = bytes_of(all);
  Everything back;
  StateArchive archive(bytes);
  archive(back);
  EXPECT_NO_THROW(archive.finish());
  EXPECT_EQ(bytes_of(back), bytes);
  EXPECT_EQ(back.text, all.text);
  EXPECT_EQ(back.lists, all.lists);
  EXPECT_EQ(back.flags, all.flags);
  EXPECT_EQ(back.column, all.column);
  EXPECT_EQ(back.vectors, all.vectors);
  EXPECT_EQ(back.pair->b, 12);
  EXPECT_FALSE(back.none.has_value());
  EXPECT_TRUE(std::signbit(back.values[1]));
}

TEST(StateArchive, WhatDoesNotFitIsRefused) {
  Everything all = example();
  const std::vector<std::uint8_t> bytes = bytes_of(all);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto cut = [&] {
      Everything back;
      StateArchive archive(std::vector<std::uint8_t>(bytes.begin(), bytes.begin() + size));
      archive(back);
      archive.finish();
    };
    EXPECT_EQ(failure(cut), misfit) << size;
  }
  std::vector<std::uint8_t> longer = bytes;
  longer.push_back(0);
  StateArchive archive(longer);
  Everything back;
  archive(back);
  EXPECT_EQ(failure([&] { archive.finish(); }), misfit);
}

TEST(StateArchive, SizesThatCannotBeAreRefusedBeforeMemoryIsAskedFor) {
  for (const std::uint64_t size :
       {std::uint64_t{1} << 62, std::numeric_limits<std::uint64_t>::max(), std::uint64_t{9}}) {
    std::vector<std::uint8_t> bytes(sizeof size + 8);
    std::memcpy(bytes.data(), &size, sizeof size);
    const auto refuses = [&](auto value) {
      StateArchive archive(bytes);
      return failure([&] { archive(value); }) == misfit;
    };
    EXPECT_TRUE(refuses(std::vector<double>())) << size;
    EXPECT_TRUE(refuses(std::vector<bool>())) << size;
    EXPECT_TRUE(refuses(std::vector<std::vector<int>>())) << size;
    EXPECT_TRUE(refuses(std::string())) << size;
    EXPECT_TRUE(refuses(Eigen::VectorXd())) << size;
  }
}

RestartPoint example_point() {
  RestartPoint point;
  point.time = 0.1 + 0.2;
  point.rows = 3;
  point.snapshots = 2;
  point.no_skip = true;
  point.case_digest = "0123456789abcdef";
  point.state = {1, 2, 3, 250};
  return point;
}

TEST(RestartPoint, IsReadAsItWasWritten) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.hdf");
  {
    Hdf5File file(path, Hdf5File::Mode::create);
    write_restart_point(file, example_point());
  }
  const RestartPoint point = read_restart_point(path).value();
  EXPECT_EQ(point.time, 0.1 + 0.2);
  EXPECT_EQ(point.rows, 3);
  EXPECT_EQ(point.snapshots, 2);
  EXPECT_TRUE(point.no_skip);
  EXPECT_EQ(point.case_digest, "0123456789abcdef");
  EXPECT_EQ(point.state, example_point().state);
}

TEST(RestartPoint, AFileWithoutOneHasNone) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.hdf");
  Hdf5File(path, Hdf5File::Mode::create).create_group("/Suffuse");
  EXPECT_FALSE(read_restart_point(path).has_value());
}

/// The digest covers all stored data.
TEST(RestartPoint, NothingOfItCanBeChangedUnnoticed) {
  const std::vector<std::function<void(RestartPoint&)>> changes{
      [](RestartPoint& point) { point.time = 0.3; },
      [](RestartPoint& point) { point.rows = 2; },
      [](RestartPoint& point) { point.rows = -1; },
      [](RestartPoint& point) { point.snapshots = 1; },
      [](RestartPoint& point) { point.no_skip = false; },
      [](RestartPoint& point) { point.case_digest.back() = 'e'; },
      [](RestartPoint& point) { point.state[1] ^= 128; },
      [](RestartPoint& point) { point.state.push_back(0); },
  };
  const std::string before = digest_of(example_point());
  for (const auto& change : changes) {
    RestartPoint point = example_point();
    change(point);
    EXPECT_NE(digest_of(point), before);
  }
}

TEST(RestartPoint, OfAnotherLayoutIsRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.hdf");
  {
    Hdf5File file(path, Hdf5File::Mode::create);
    file.create_group(layout::restart_group);
    const std::int64_t layout = 999;
    file.attribute(layout::restart_group, "layout", std::span(&layout, 1));
    const std::vector<std::uint8_t> state(3);
    file.write(layout::restart_state, std::span(state), {state.size()});
  }
  EXPECT_NE(failure([&] { read_restart_point(path); }).find("keeps a state of layout 999"),
            std::string::npos);
}

TEST(GrowingTable, GoesOnBehindTheRowsThatAreKept) {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.csv", "t,x\n0,1\n1,2\n2,3\n3,");
  GrowingTable table(path, 2);
  EXPECT_EQ(read_file(path), "t,x\n0,1\n1,2\n");
  table.append("2,30\n");
  table.append("3,40\n");
  EXPECT_EQ(read_file(path), "t,x\n0,1\n1,2\n2,30\n3,40\n");
  GrowingTable anew(path, "t");
  anew.append("0\n");
  EXPECT_EQ(read_file(path), "t\n0\n");
}

/// Tables as a run leaves them if it is stopped while it writes.
TEST(RestartPoint, NeedsItsRowsInEveryTable) {
  const TemporaryFolder folder;
  const std::string path = folder.file("");
  const std::vector<TableFile> tables{
      {"history.csv", "", 1}, {"boundaries.csv", "", 3}, {"probes.csv", "", 0}};
  {
    Hdf5File file(folder.file("checkpoint.hdf"), Hdf5File::Mode::create);
    RestartPoint point = example_point();
    point.rows = 2;
    point.snapshots = 0;
    write_restart_point(file, point);
  }
  folder.write("history.csv", "t\n0\n1\n2\n");
  folder.write("boundaries.csv", "t\n0\n0\n0\n1\n1\n1\n2\n");
  EXPECT_FALSE(newest_restart_point(path, false, tables).point) << "a table is missing";
  folder.write("probes.csv", "t\n");
  EXPECT_TRUE(newest_restart_point(path, false, tables).point);
  folder.write("boundaries.csv", "t\n0\n0\n0\n1\n1\n1");
  EXPECT_FALSE(newest_restart_point(path, false, tables).point) << "a row is not ended";
}

TEST(GrowingTable, NoticesThatItsFileIsNoLongerThere) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.csv");
  const std::string message =
      path + ": was removed or changed by another program while the run wrote to it";
  {
    GrowingTable table(path, "t");
    fs::remove(path);
    EXPECT_EQ(failure([&] { table.append("0\n"); }), message);
  }
  GrowingTable table(path, "t");
  folder.write("a.csv", "t\n0\n0\n0\n");
  EXPECT_EQ(failure([&] { table.append("0\n"); }), message);
}

TEST(FolderLock, IsGivenToOneAtATime) {
  const TemporaryFolder place;
  const std::string folder = place.file("results");
  const std::string lock = folder + "/.lock";
  {
    const FolderLock held(folder);
    const std::string holder = read_file(lock);
    EXPECT_TRUE(holder.starts_with("process " + std::to_string(::getpid()) + " on ")) << holder;
    EXPECT_EQ(failure([&] { FolderLock second(folder); }),
              folder + ": another suffuse-solver writes there (" +
                  holder.substr(0, holder.size() - 1) +
                  "); wait for it, or choose another folder with -o");
    place.write("results/run.json", "{}");
  }
  EXPECT_EQ(read_file(lock), "") << "nobody holds it";
  FolderLock first(folder);
  FolderLock moved(std::move(first));
  EXPECT_NE(failure([&] { FolderLock second(folder); }), "no FileError");
  moved = FolderLock();
  EXPECT_EQ(failure([&] { FolderLock second(folder); }), "no FileError");
}

TEST(FolderLock, LeavesNoFolderThatHasNothingElse) {
  const TemporaryFolder place;
  const std::string folder = place.file("a/results");
  { const FolderLock lock(folder); }
  EXPECT_FALSE(fs::exists(folder));
  fs::create_directories(folder);
  { const FolderLock lock(folder); }
  EXPECT_TRUE(fs::exists(folder)) << "was there before";
}

TEST(FolderLock, GoesWithTheProcessThatHeldIt) {
  const TemporaryFolder place;
  const std::string folder = place.file("results");
  fs::create_directories(folder);
  const pid_t child = ::fork();
  if (child == 0) {
    const FolderLock lock(folder);
    ::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_NE(read_file(folder + "/.lock"), "");
  EXPECT_EQ(failure([&] { FolderLock lock(folder); }), "no FileError");
}

}  // namespace restart_state_test
}  // namespace suffuse
