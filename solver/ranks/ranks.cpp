#include "ranks/ranks.hpp"

#include <filesystem>
#include <new>

#include "common/errors.hpp"

namespace suffuse {
namespace {

/// A letter for the kind of an error, and its message.
std::string message_of(const std::exception_ptr& error) {
  if (!error) return "";
  try {
    std::rethrow_exception(error);
  } catch (const InputError& e) {
    // Whether the message begins with a place of the user's input.
    const bool has_place = !e.problems().empty() && !e.problems().front().where.empty();
    return (has_place ? "I" : "i") + std::string(e.what());
  } catch (const NumericalError& e) {
    return std::string("N") + e.what();
  } catch (const FileError& e) {
    return std::string("F") + e.what();
  } catch (const std::filesystem::filesystem_error& e) {
    return "F" + e.path1().string() + ": " + e.code().message();
  } catch (const std::bad_alloc&) {
    return "M";
  } catch (const std::exception& e) {
    return std::string("B") + e.what();
  } catch (...) {
    return "Ban unknown exception";
  }
}

}  // namespace

void throw_together(const Ranks& ranks, const std::exception_ptr& own) {
  const std::string first = ranks.first_text(message_of(own));
  if (first.empty()) return;
  const std::string message = first.substr(1);
  switch (first.front()) {
    case 'I':
      throw InputError(InputProblem{.where = message});
    case 'i':
      throw InputError(message);
    case 'N':
      throw NumericalError(message);
    case 'F':
      throw FileError(message);
    case 'M':
      throw std::bad_alloc();
    default:
      throw std::runtime_error(message);
  }
}

}  // namespace suffuse
