#include "gmsh_session.hpp"

#include <gmsh.h>

#include <new>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "common/errors.hpp"

namespace suffuse {

namespace {

/// The first error that Gmsh logged from line `from` of its log on; empty if there is none. Gmsh
/// does not throw an exception for every error.
std::string first_logged_error(std::size_t from) {
  constexpr std::string_view prefix = "Error: ";
  std::vector<std::string> lines;
  gmsh::logger::get(lines);
  for (std::size_t i = from; i < lines.size(); ++i) {
    if (lines[i].starts_with(prefix)) return lines[i].substr(prefix.size());
  }
  return "";
}

std::size_t log_length() {
  std::vector<std::string> lines;
  gmsh::logger::get(lines);
  return lines.size();
}

}  // namespace

GmshSession::GmshSession() {
  constexpr bool read_configuration = false;
  gmsh::initialize(0, nullptr, read_configuration);
  // An error ends the meshing and is logged. As an exception, Gmsh's default, it would end the
  // program if it left one of Gmsh's parallel regions.
  gmsh::option::setNumber("General.AbortOnError", 1);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.NoPopup", 1);
  gmsh::option::setNumber("General.NumThreads", 1);
  gmsh::option::setNumber("Mesh.RandomSeed", 1);
  gmsh::logger::start();
}

GmshSession::~GmshSession() {
  gmsh::logger::stop();
  gmsh::finalize();
}

std::string gmsh_complaint(const std::function<void()>& body) {
  const std::size_t before = log_length();
  std::string thrown;
  try {
    body();
  } catch (const std::string& message) {
    thrown = message;
  } catch (const char* message) {
    thrown = message;
  } catch (int code) {
    thrown = "error " + std::to_string(code);
  } catch (const std::bad_alloc&) {
    thrown = no_memory;
  } catch (const std::length_error&) {
    thrown = no_memory;
  }
  const std::string logged = first_logged_error(before);
  return logged.empty() ? thrown : logged;
}

}  // namespace suffuse
