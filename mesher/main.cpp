#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "case/case_file.hpp"
#include "case/plausibility.hpp"
#include "common/closest_name.hpp"
#include "common/command_line.hpp"
#include "common/errors.hpp"
#include "geometry.hpp"
#include "gmsh_export.hpp"
#include "grading_summary.hpp"
#include "scene/scene_schema.hpp"
#include "scene/soil_grading.hpp"
#include "seeding.hpp"
#include "summary.hpp"

namespace {

using namespace suffuse;
namespace fs = std::filesystem;

constexpr const char* program = "suffuse-mesher";

constexpr const char* exit_codes = R"(Exit codes:
  0    done
  2    the scene, the geometry or the command line is wrong
  3    out of memory, or a bug
  4    a file cannot be read or written
  130  interrupted by Ctrl-C
With another code than 0 there is no new case file.
)";

struct Arguments {
  std::string scene;
  std::string output;
  std::string msh;
  std::string sizes;
  std::vector<std::string> overrides;
  double geometry_timeout = default_geometry_seconds;
  bool check = false;
  bool version = false;
  bool scene_reference = false;
};

void refuse_unknown(const std::vector<std::string>& unknown) {
  if (unknown.empty()) return;
  const std::vector<std::string> known{"--output",           "--set",   "--msh",     "--sizes",
                                       "--geometry-timeout", "--check", "--version", "--help",
                                       "--scene-reference"};
  const std::string& first = unknown.front();
  const bool is_option = first.starts_with("-");
  const std::string name = first.substr(0, first.find('='));
  const std::string closest = is_option ? closest_name(name, known) : "";
  throw InputError(std::vector<InputProblem>{
      {"", "", '"' + first + '"',
       is_option ? "an option of " + std::string(program) + " (see --help)" : "one scene file only",
       closest}});
}

/// `name` plus `.case.h5` in the current folder, unless `-o` says otherwise.
std::string output_path(const Arguments& arguments) {
  if (!arguments.output.empty()) return arguments.output;
  return fs::path(arguments.scene).stem().string() + ".case.h5";
}

/// Notes the place of the case if `-o` does not give it and it is not next to the scene.
std::vector<std::string> place_notes(const Arguments& arguments) {
  const std::string output = output_path(arguments);
  const std::string beside = file_beside_scene(arguments.scene, output);
  std::error_code ignored;
  if (!arguments.output.empty() || fs::equivalent(output, beside, ignored)) return {};
  return {"the case is in the current folder, " + fs::absolute(output).string() + "; -o " + beside +
          " puts it beside the scene"};
}

/// Refuses outputs that would overwrite an input.
void check_outputs(const Arguments& arguments, const SceneDocument& document) {
  std::vector<std::string> inputs{arguments.scene};
  if (!document.scene.geometry.file.empty()) inputs.push_back(geometry_path(document));
  if (!arguments.sizes.empty()) inputs.push_back(arguments.sizes);
  for (const auto& [name, text] : document.files) {
    inputs.push_back(file_beside_scene(document.path, name));
  }
  for (const std::string& input : inputs) {
    if (same_file(output_path(arguments), input)) {
      throw InputError("-o " + output_path(arguments) + " would overwrite an input; name another");
    }
    if (!arguments.msh.empty() && same_file(arguments.msh, input)) {
      throw InputError("--msh " + arguments.msh + " would overwrite an input; name another");
    }
  }
  if (arguments.msh.empty()) return;
  if (fs::path(arguments.msh).extension() != ".msh") {
    throw InputError("--msh: got " + arguments.msh + "; expected a name that ends in .msh");
  }
  if (same_file(arguments.msh, output_path(arguments))) {
    throw InputError("-o and --msh name the same file " + arguments.msh);
  }
}

template <int Dim>
void refuse_too_many_points(const SceneDocument& document, const Mesh<Dim>& mesh) {
  // A larger number is probably due to a misplaced decimal point.
  constexpr double max_points = 1e8;
  double count = 0.0;
  for (const std::int64_t of_element : liquid_point_counts(mesh, document.scene)) {
    count += static_cast<double>(of_element);
  }
  if (count <= max_points) return;
  const std::string key = "points.liquid_per_element";
  throw InputError(std::vector<InputProblem>{
      {document.locate(key), key, shown_number(count) + " liquid points in all",
       "at most 100 million: fewer per element, or larger elements", ""}});
}

template <int Dim>
Case<Dim> seed(const SceneDocument& document, Mesh<Dim> mesh) {
  Case<Dim> result{document, std::move(mesh), {}, {}};
  complete_for_mesh(result.document, Dim);
  const Scene& scene = result.document.scene;
  result.solid_points = seed_solid_points(result.mesh, scene);
  if (scene.formulation == Formulation::double_point) {
    refuse_too_many_points(document, result.mesh);
    result.liquid_points = seed_liquid_points(result.mesh, scene);
  }
  return result;
}

SceneDocument scene_of(const Arguments& arguments) {
  if (arguments.scene.empty()) {
    throw InputError("a scene file is missing; expected suffuse-mesher SCENE.toml (see --help)");
  }
  return read_scene(arguments.scene, arguments.overrides);
}

void warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    std::cerr << program << ": warning: " << warning << '\n';
  }
}

void check_gradings(const Arguments& arguments) {
  for (const auto& [option, value] :
       {std::pair("-o", arguments.output), std::pair("--msh", arguments.msh)}) {
    if (value.empty()) continue;
    throw InputError("--check with " + std::string(option) +
                     ": it writes no file; expected one of the two");
  }
  if (!arguments.sizes.empty()) {
    throw InputError("--check with --sizes: it makes no mesh; expected one of the two");
  }
  const SceneDocument document = scene_of(arguments);
  std::cout << grading_report(document);
  warn(grading_warnings(document));
}

template <int Dim>
void make_case_of(const Arguments& arguments, const SceneDocument& document,
                  Geometry<Dim> geometry) {
  const Case<Dim> result = seed(document, std::move(geometry.mesh));
  if (!arguments.msh.empty()) write_gmsh(arguments.msh, result.mesh);
  write_case(output_path(arguments), result);

  std::vector<std::string> notes = place_notes(arguments);
  notes.insert(notes.end(), geometry.notes.begin(), geometry.notes.end());
  std::cout << output_path(arguments) << '\n'
            << case_summary(result, notes) << grading_summary(document);
  const std::string warning = angle_warning(result.mesh);
  if (!warning.empty()) warn({warning});
  warn(plausibility_warnings(document, result.mesh));
  warn(suction_warnings(document, result.mesh));
  warn(grading_warnings(document));
}

void make_case(const Arguments& arguments) {
  SceneDocument document = scene_of(arguments);
  check_outputs(arguments, document);
  std::optional<WantedSizes> wanted;
  if (!arguments.sizes.empty()) {
    wanted = read_wanted_sizes(arguments.sizes);
    document = scene_with_sizes(std::move(document), *wanted);
  }
  std::visit([&](auto geometry) { make_case_of(arguments, document, std::move(geometry)); },
             build_geometry({document, arguments.geometry_timeout, wanted ? &*wanted : nullptr}));
}

std::string refuse_empty(const std::string& name) {
  return name.empty() ? "got an empty name; expected that of a file" : "";
}

int run(int argc, char** argv) {
  CLI::App app{"Makes a case file, mesh and material points, from a scene.", program};
  Arguments arguments;
  app.add_option("SCENE", arguments.scene, "scene file (TOML)")->type_name("FILE");
  app.add_option("-o,--output", arguments.output, "case file to write [SCENE's name .case.h5]")
      ->check(refuse_empty)
      ->type_name("FILE");
  app.add_option("--set", arguments.overrides, "change a key of the scene, repeatable")
      ->type_name("KEY=VALUE")
      ->type_size(1)
      ->allow_extra_args(false);
  app.add_option("--msh", arguments.msh, "also write the mesh for the Gmsh program")
      ->check(refuse_empty)
      ->type_name("FILE.msh");
  app.add_option("--sizes", arguments.sizes,
                 "sizes of elements, written by suffuse-solver --sizes, instead of mesh.size")
      ->check(refuse_empty)
      ->type_name("FILE.h5");
  app.add_option("--geometry-timeout", arguments.geometry_timeout,
                 "processor time after which Gmsh is stopped over geometry.file")
      ->check(number_in(1e-3, 1e9))
      ->capture_default_str()
      ->type_name("SECONDS");
  app.add_flag("--check", arguments.check,
               "only check the gradations of the soils, and write nothing");
  app.add_flag("--version", arguments.version, "print the version");
  app.add_flag("--scene-reference", arguments.scene_reference,
               "print the reference of all scene keys (Markdown)");
  app.footer(exit_codes);
  app.allow_extras();
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    throw InputError(std::string(error.what()) + " (see --help)");
  }
  refuse_unknown(app.remaining());
  if (arguments.version) {
    std::cout << program << ' ' << SUFFUSE_VERSION << '\n';
  } else if (arguments.scene_reference) {
    std::cout << scene_reference_markdown();
  } else if (arguments.check) {
    check_gradings(arguments);
  } else {
    make_case(arguments);
  }
  return static_cast<int>(ExitCode::done);
}

}  // namespace

int main(int argc, char** argv) {
  return run_program(program, [&] { return run(argc, argv); });
}
