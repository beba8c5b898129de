#pragma once

/// Private disks of a test, of any size, possibly read-only.

#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace suffuse::test {

/// Whether this process can mount a disk that no other process sees: as root, or as the root of its
/// own name space, which it enters if necessary.
inline bool can_mount() {
  static const bool can = [] {
    const uid_t user = ::geteuid();
    const gid_t group = ::getegid();
    if (::unshare(CLONE_NEWNS) != 0) {
      if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
      std::ofstream("/proc/self/setgroups") << "deny";
      std::ofstream("/proc/self/uid_map") << "0 " << user << " 1";
      std::ofstream("/proc/self/gid_map") << "0 " << group << " 1";
    }
    return ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0;
  }();
  return can;
}

/// A disk of `bytes` bytes in memory, mounted on a new folder.
class SmallDisk {
 public:
  SmallDisk(std::string folder, std::uintmax_t bytes) : folder_(std::move(folder)) {
    std::filesystem::create_directories(folder_);
    mounted_ =
        can_mount() && ::mount("tmpfs", folder_.c_str(), "tmpfs", 0, size(bytes).c_str()) == 0;
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  ~SmallDisk() {
    if (mounted_) ::umount2(folder_.c_str(), MNT_DETACH);
  }
  [[nodiscard]] bool mounted() const { return mounted_; }
  bool resize(std::uintmax_t bytes) const {
    return ::mount("tmpfs", folder_.c_str(), "tmpfs", MS_REMOUNT, size(bytes).c_str()) == 0;
  }
  bool make_read_only() const {
    return ::mount("tmpfs", folder_.c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, nullptr) == 0;
  }
  /// Fills the remaining space with a file of this name.
  void fill(const std::string& name) const {
    const int file = ::open((folder_ + "/" + name).c_str(), O_WRONLY | O_CREAT, 0666);
    const std::string page(4096, 'x');
    while (::write(file, page.data(), page.size()) > 0) {
    }
    ::close(file);
  }

 private:
  static std::string size(std::uintmax_t bytes) { return "size=" + std::to_string(bytes); }
  std::string folder_;
  bool mounted_ = false;
};

}  // namespace suffuse::test
