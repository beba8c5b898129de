/// A process that reads an untrusted file: what it may not do, how it ends, what it returns.

#include "confined_child.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <seccomp.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <new>
#include <thread>

#include "common/errors.hpp"
#include "gmsh_reply.hpp"
#include "temporary_folder.hpp"

namespace suffuse {
namespace confined_child_test {

using How = ChildEnd::How;

ChildEnd end_of(const std::function<std::string()>& body, ChildLimits limits = {5.0, 20.0, 1e9}) {
  return run_confined([] {}, body, limits);
}

ChildEnd end_of_doing(const std::function<void()>& act) {
  return end_of([&] {
    act();
    return std::string("went on");
  });
}

void expect_refused(const std::function<void()>& act, const std::string& words) {
  const ChildEnd end = end_of_doing(act);
  EXPECT_EQ(end.how, How::refused) << words;
  EXPECT_EQ(end.text, words);
}

TEST(ConfinedChild, RepliesWithWhatItReads) {
  const test::TemporaryFolder folder;
  const std::string path = folder.write("a.txt", "what it says");
  EXPECT_EQ(end_of([&] { return test::read_file(path); }).text, "what it says");
  const std::string large(std::size_t{3} << 20U, 'x');
  EXPECT_EQ(end_of([&] { return large; }).text, large);
}

TEST(ConfinedChild, StartsNoProcessAndNoThread) {
  const std::string words = "run a command or start a process";
  expect_refused([] { static_cast<void>(!std::system("true")); }, words);  // NOLINT
  expect_refused([] { ::fork(); }, words);
  expect_refused([] { ::execl("/bin/true", "true", nullptr); }, words);
  expect_refused([] { std::thread([] {}).join(); }, words);
}

TEST(ConfinedChild, WritesNothing) {
  const test::TemporaryFolder folder;
  const std::string path = folder.write("old.txt", "old");
  const std::string fresh = folder.file("new.txt");
  expect_refused([&] { std::ofstream(fresh) << 1; }, "write the file \"" + fresh + '"');
  expect_refused([&] { ::open(path.c_str(), O_RDWR); }, "write the file \"" + path + '"');
  expect_refused([&] { ::open(path.c_str(), O_RDONLY | O_TRUNC); },
                 "write the file \"" + path + '"');
  const std::string words = "make, change or remove files";
  expect_refused([&] { ::unlink(path.c_str()); }, words);
  expect_refused([&] { ::rename(path.c_str(), fresh.c_str()); }, words);
  expect_refused([&] { ::mkdir(fresh.c_str(), 0700); }, words);
  expect_refused([&] { ::symlink("/etc", fresh.c_str()); }, words);
  expect_refused([&] { ::truncate(path.c_str(), 0); }, words);
  expect_refused([&] { ::chmod(path.c_str(), 0777); }, words);
  EXPECT_EQ(test::read_file(path), "old");
  EXPECT_EQ(folder.count(), 1);
}

TEST(ConfinedChild, TalksToNobodyAndWaitsForNothing) {
  expect_refused([] { ::socket(AF_INET, SOCK_STREAM, 0); }, "open a connection");
  expect_refused([] { ::sleep(1000); }, "wait");
  const ChildEnd end = end_of([] { return std::to_string(::kill(::getppid(), SIGTERM)); });
  EXPECT_EQ(end.how, How::replied);
  EXPECT_EQ(end.text, "-1");
}

TEST(ConfinedChild, ReadsRegularFilesAlone) {
  const test::TemporaryFolder folder;
  const std::string pipe = folder.file("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  expect_refused([&] { std::ifstream stream(pipe); }, "read \"" + pipe + "\", no regular file");
  expect_refused([&] { std::ifstream stream("/dev/zero"); }, "read \"/dev/zero\", no regular file");
}

TEST(ConfinedChild, EndsAtItsLimits) {
  const auto never_end = [] {
    for (std::atomic<int> rounds = 0;; ++rounds) {
    }
    return std::string();
  };
  EXPECT_EQ(end_of(never_end, {0.3, 20.0, 1e9}).how, How::processor_time);
  const auto wait = [] {
    std::mutex never_free;
    never_free.lock();
    never_free.lock();
    return std::string();
  };
  EXPECT_EQ(end_of(wait, {5.0, 0.3, 1e9}).how, How::wall_time);
  EXPECT_EQ(end_of([] { return std::string(2000000, 'x'); }, {5.0, 20.0, 1e6}).how, How::memory);
  EXPECT_EQ(end_of_doing([] { throw std::bad_alloc(); }).how, How::memory);
}

TEST(ConfinedChild, CrashesAlone) {
  EXPECT_EQ(end_of_doing([] { ::raise(SIGSEGV); }).how, How::crashed);
  EXPECT_EQ(end_of_doing([] { std::abort(); }).how, How::crashed);
  EXPECT_EQ(end_of_doing([] { ::_exit(0); }).how, How::left);
}

TEST(ConfinedChild, HasNoDescriptorOfItsParent) {
  const test::TemporaryFolder folder;
  const std::string path = folder.write("open.txt", "old");
  const int open_file = ::open(path.c_str(), O_RDWR);
  ASSERT_GE(open_file, 0);
  const ChildEnd end =
      end_of([&] { return std::to_string(open_file > 3 ? ::write(open_file, "new", 3) : -1); });
  ::close(open_file);
  EXPECT_EQ(end.text, "-1");
  EXPECT_EQ(test::read_file(path), "old");
}

/// Forbids filters, as some containers do.
void forbid_filters() {
  const scmp_filter_ctx filter = ::seccomp_init(SCMP_ACT_ALLOW);
  ::seccomp_rule_add(filter, SCMP_ACT_ERRNO(EPERM), SCMP_SYS(seccomp), 0);
  ::seccomp_rule_add(filter, SCMP_ACT_ERRNO(EPERM), SCMP_SYS(prctl), 1,
                     scmp_arg_cmp{0, SCMP_CMP_EQ, PR_SET_SECCOMP, 0});
  ::seccomp_load(filter);
}

TEST(ConfinedChild, DoesNotRunUnconfined) {
  const auto message = [] {
    try {
      run_confined(forbid_filters, [] { return std::string("ran"); }, {5.0, 20.0, 1e9});
    } catch (const FileError& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  EXPECT_EQ(message().find("a geometry file can run commands, and this system has no way to "
                           "prevent it: "),
            0U)
      << message();
}

// What the child returns

GmshReply small_reply() {
  GmshReply reply;
  reply.meshes_itself = true;
  reply.model.node_tags = {1, 2, 5};
  reply.model.coordinates = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  reply.model.entities.push_back(
      {2, 1, {0, 0, 0, 1, 1, 0}, {{2, "Triangle 3", 3, {7}, {1, 2, 5}}}});
  reply.model.groups.push_back({2, 1, "sand", {1}, {}});
  return reply;
}

TEST(GmshReply, ComesAsItWent) {
  const std::string bytes = bytes_of(small_reply());
  const GmshReply reply = reply_from(bytes);
  EXPECT_TRUE(reply.meshes_itself);
  EXPECT_EQ(reply.model.entities.at(0).elements.at(0).nodes, (std::vector<std::size_t>{1, 2, 5}));
  EXPECT_EQ(reply.model.groups.at(0).name, "sand");
  EXPECT_EQ(bytes_of(reply), bytes);
}

TEST(GmshReply, IsRefusedUnlessWhole) {
  const std::string whole = bytes_of(small_reply());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THROW(reply_from(whole.substr(0, size)), InputError) << size;
  }
  EXPECT_THROW(reply_from(whole + 'x'), InputError);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const int bits : {0x01, 0x80, 0xff}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ bits);
      try {
        static_cast<void>(reply_from(damaged));
      } catch (const InputError&) {
      }
    }
  }
}

TEST(GmshReply, HasNoElementsAtUnknownNodes) {
  GmshReply reply = small_reply();
  reply.model.entities[0].elements[0].nodes[1] = 3;
  EXPECT_THROW(reply_from(bytes_of(reply)), InputError);
  reply = small_reply();
  reply.model.entities[0].elements[0].nodes_each = 1;
  EXPECT_THROW(reply_from(bytes_of(reply)), InputError);
  reply = small_reply();
  reply.model.coordinates.pop_back();
  EXPECT_THROW(reply_from(bytes_of(reply)), InputError);
}

TEST(GmshReply, MovesNoCursor) {
  GmshReply reply;
  reply.problems.push_back({"", "", "\033[2Jtext\nmore", "", ""});
  EXPECT_EQ(reply_from(bytes_of(reply)).problems.at(0).found, "?[2Jtext\nmore");
}

}  // namespace confined_child_test
}  // namespace suffuse
