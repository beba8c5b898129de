#include "common/errors.hpp"

#include <fcntl.h>

#include <csignal>
#include <filesystem>
#include <iostream>
#include <new>
#include <utility>

namespace suffuse {
namespace {

std::string join_messages(const std::vector<InputProblem>& problems) {
  std::string lines;
  for (const InputProblem& problem : problems) {
    if (!lines.empty()) lines += '\n';
    lines += problem.message();
  }
  return lines;
}

}  // namespace

std::string InputProblem::message() const {
  std::string finding;
  const auto add = [&finding](const std::string& part) {
    if (!finding.empty()) finding += "; ";
    finding += part;
  };
  if (!found.empty()) add("got " + found);
  if (!expected.empty()) add("expected " + expected);
  if (!suggestion.empty()) add("did you mean " + suggestion + "?");

  std::string message;
  for (const std::string& part : {where, key, finding}) {
    if (part.empty()) continue;
    if (!message.empty()) message += ": ";
    message += part;
  }
  return message;
}

InputError::InputError(std::vector<InputProblem> problems)
    : std::runtime_error(join_messages(problems)), problems_(std::move(problems)) {}

InputError::InputError(InputProblem problem) : InputError(std::vector{std::move(problem)}) {}

InputError::InputError(const std::string& sentence) : InputError(InputProblem{.key = sentence}) {}

void prepare_process() {
  for (const int stream : {0, 1, 2}) {
    if (::fcntl(stream, F_GETFD) != -1) continue;
    // open() returns the lowest free number, which is this one.
    static_cast<void>(::open("/dev/null", O_RDWR));
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

int report_current_exception(const std::string& program, bool silent) {
  const auto report = [&](const std::string& message, ExitCode code) {
    if (!silent) std::cerr << program << ": error: " << message << '\n';
    return static_cast<int>(code);
  };
  try {
    throw;
  } catch (const InputError& error) {
    const bool has_place = !error.problems().empty() && !error.problems().front().where.empty();
    if (!has_place) return report(error.what(), ExitCode::wrong_input);
    if (!silent) std::cerr << error.what() << '\n';
    return static_cast<int>(ExitCode::wrong_input);
  } catch (const NumericalError& error) {
    return report(error.what(), ExitCode::numerical_failure);
  } catch (const FileError& error) {
    return report(error.what(), ExitCode::file_failure);
  } catch (const std::filesystem::filesystem_error& error) {
    return report(error.path1().string() + ": " + error.code().message(), ExitCode::file_failure);
  } catch (const std::bad_alloc&) {
    return report("out of memory; use a coarser mesh or fewer points", ExitCode::numerical_failure);
  } catch (const std::exception& error) {
    return report(std::string("this is a bug in Suffuse, please report it: ") + error.what(),
                  ExitCode::numerical_failure);
  } catch (...) {
    return report("this is a bug in Suffuse, please report it: an unknown exception",
                  ExitCode::numerical_failure);
  }
}

}  // namespace suffuse
