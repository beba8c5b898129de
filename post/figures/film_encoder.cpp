#include "figures/film_encoder.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include "common/errors.hpp"
#include "common/pending_file.hpp"

namespace suffuse {
namespace {

/// Runs a program of the PATH without a shell, with no input and with its messages in a file.
/// Returns its exit code, 128 if a signal ended it, or nothing if there is no such program.
std::optional<int> run_program(std::vector<std::string> arguments, const std::string& messages) {
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions{};
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, messages.c_str(), O_WRONLY | O_CREAT,
                                   0600);
  pid_t process = 0;
  const int failure =
      ::posix_spawnp(&process, pointers[0], &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure == ENOENT) return std::nullopt;
  if (failure != 0) throw FileError(arguments[0] + ": " + std::strerror(failure));
  int status = 0;
  while (::waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) throw FileError(arguments[0] + ": " + std::strerror(errno));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

std::string first_line(const std::string& path) {
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  return line;
}

}  // namespace

bool encode_mp4(const std::string& pattern, int rate, const std::string& folder,
                const std::string& path) {
  PendingFile file(path);
  const std::string messages = (std::filesystem::path(folder) / "ffmpeg.txt").string();
  const auto code = run_program({"ffmpeg", "-nostdin", "-loglevel", "error", "-y", "-framerate",
                                 std::to_string(rate), "-start_number", "0", "-i", pattern,
                                 // H.264 in yuv420p needs even sizes.
                                 "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:0:0:white", "-c:v",
                                 "libx264", "-crf", "18", "-pix_fmt", "yuv420p", "-movflags",
                                 "+faststart", "-f", "mp4", "file:" + file.temporary_path()},
                                messages);
  if (!code) return false;
  if (*code != 0) {
    throw FileError(path + ": ffmpeg failed with exit code " + std::to_string(*code) + ": " +
                    first_line(messages) + "; -o NAME.png needs no ffmpeg");
  }
  file.commit();
  return true;
}

}  // namespace suffuse
