#include "vocabulary.hpp"

#include <hdf5.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "bytes.hpp"
#include "common/scratch_folder.hpp"
#include "scene/scene_schema.hpp"
#include "seeds.hpp"

namespace suffuse::fuzz {
namespace {

using Json = nlohmann::json;

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at)) {
    text.replace(at, what.size(), by);
  }
  return text;
}

std::vector<std::string> values_of(const SceneKey& key) {
  std::vector<std::string> values{"0", "-1", "1", "true", "\"\"", "nan"};
  for (const std::string& word : key.words) values.push_back('"' + word + '"');
  for (const std::int64_t integer : key.integers) values.push_back(std::to_string(integer));
  if (key.default_value) values.push_back(shown_value(*key.default_value));
  switch (key.kind) {
    case ValueKind::number:
    case ValueKind::number_or_word:
      values.insert(values.end(), {"0.3", "0.999999", "1e-3", "1e-12", "1e-300", "5e-324", "1e3",
                                   "1e12", "1e300", "inf", "-inf", "10.0"});
      break;
    case ValueKind::number_or_pair:
      values.insert(values.end(), {"1e-5", "[1e-5, 1e-6]", "[1e-300, 1e300]", "[1, 0]", "[1]",
                                   "[1, 2, 3]", "[]", "[inf, nan]"});
      break;
    case ValueKind::integer:
      values.insert(values.end(), {"2", "7", "12", "1000000", "2147483647", "2147483648",
                                   "9223372036854775807", "-9223372036854775808"});
      break;
    case ValueKind::vector:
      values.insert(values.end(), {"[0,-9.81]", "[1e300,1e300]", "[0.1,0]", "[0,0,1]", "[]",
                                   "[nan,0]", "[1e-300,-1e-300]"});
      break;
    case ValueKind::vector_function:
      values.insert(values.end(), {"[0,-1e4]", "[0,0,1]", "[[0,0,0],[1,0,-1e4]]", "[[0,0,0,0]]",
                                   "[[0,0,0],[1,0]]", "[[1,0,0],[1,0,0]]", "[[]]", "[nan,0]"});
      break;
    case ValueKind::function:
      values.insert(values.end(),
                    {"1e3", "-1e-3", "1e300", "[[0,0],[1,1]]", "[[0,1e3],[5,0],[5,1]]", "[[0,1]]",
                     "[[1,0],[0,1]]", "[[0,0],[1e-300,1]]", "[[0,0],[1e300,1e300]]", "[]",
                     "[[0],[1]]", "[[-1e300,-1e300],[1e300,1e300]]"});
      break;
    case ValueKind::gradation:
      values.insert(values.end(),
                    {"[[0.1,5],[0.2,20],[1,22],[4,60],[10,100]]", "[[0.1,0],[1,50],[10,100]]",
                     "[[1e-6,0],[1,0],[1e6,100]]", "[[1,40],[2,40],[3,100]]", "[[1,0],[2,100]]",
                     "[[1,0],[2,50],[3,99]]", "[[1,0],[1,50],[3,100]]", "[[1,9],[2,5],[3,100]]",
                     "[[1,0],[2,50],[3,100],[4,100]]", "[[1,nan],[2,50],[inf,100]]", "[[1]]"});
      break;
    case ValueKind::text:
    case ValueKind::word:
    case ValueKind::boolean:
      values.insert(values.end(), {"false", "\"specimen\"", "\"buffer\"", "\"top\"", "\"inflow\"",
                                   "\"outflow\"", "\"left\"", "{}", "[]", "[{}]"});
      break;
  }
  return values;
}

/// Adds the names of objects and attributes of an HDF5 file.
void add_names(const std::string& bytes, Vocabulary& words) {
  const ScratchFolder scratch("suffuse-words");
  const std::string path = (scratch.path() / "a.h5").string();
  write_bytes(path, bytes);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  H5Ovisit(
      file, H5_INDEX_NAME, H5_ITER_INC,
      [](hid_t root, const char* name, const H5O_info_t*, void* out) -> herr_t {
        auto& found = *static_cast<Vocabulary*>(out);
        const std::string object = "/" + std::string(name == std::string(".") ? "" : name);
        found.objects.push_back(object);
        const hid_t opened = H5Oopen(root, object.c_str(), H5P_DEFAULT);
        for (int i = 0; i < H5Aget_num_attrs(opened); ++i) {
          std::string attribute(64, '\0');
          const ssize_t length =
              H5Aget_name_by_idx(opened, ".", H5_INDEX_NAME, H5_ITER_INC, static_cast<hsize_t>(i),
                                 attribute.data(), attribute.size(), H5P_DEFAULT);
          attribute.resize(static_cast<std::size_t>(std::max<ssize_t>(length, 0)));
          found.attributes.push_back(object + " " + attribute);
        }
        H5Oclose(opened);
        return 0;
      },
      &words);
  H5Fclose(file);
}

// NOLINTNEXTLINE(misc-no-recursion): as deep as the file
void add_pointers(const Json& json, const std::string& pointer, Vocabulary& words) {
  words.pointers.push_back(pointer);
  if (!json.is_structured() || words.pointers.size() > 200) return;
  for (const auto& [key, value] : json.items()) add_pointers(value, pointer + "/" + key, words);
}

void make_unique(std::vector<std::string>& all) {
  const std::set<std::string> sorted(all.begin(), all.end());
  all.assign(sorted.begin(), sorted.end());
}

Vocabulary vocabulary(const std::map<std::string, Files>& seeds, bool has_files) {
  Vocabulary words;
  words.seeds = names(seeds);
  words.settings = scene_settings();
  for (const auto& [name, files] : seeds) {
    for (const auto& [file, bytes] : files) {
      if (has_files) words.files.push_back(file);
      if (file.ends_with(".h5") || file.ends_with("_000000.hdf")) add_names(bytes, words);
      if (file.ends_with(".json") || file.ends_with(".series")) {
        add_pointers(Json::parse(bytes), "", words);
      }
    }
  }
  for (auto* all : {&words.files, &words.objects, &words.attributes, &words.pointers}) {
    make_unique(*all);
  }
  return words;
}

}  // namespace

std::vector<std::string> scene_settings() {
  std::vector<std::string> all;
  for (const SceneKey& key : scene_keys()) {
    std::vector<std::string> places;
    for (const std::string soil : {"specimen", "buffer"}) {
      for (const std::string entry : {"[0]", "[1]", "[2]"}) {
        places.push_back(replaced(replaced(key.pattern, "*", soil), "[]", entry));
      }
    }
    make_unique(places);
    for (const std::string& place : places) {
      for (const std::string& value : values_of(key)) all.push_back(place + "=" + value);
    }
  }
  // Whole entries, because single keys seldom add up to a valid scene.
  for (const std::string entry :
       {R"(boundary[0]={on="top", head=[[0, 2], [5, 0.5]]})",
        R"(boundary[1]={on="left", head=0.5, dry="suction"})",
        R"(boundary[1]={on="right", seepage_face=true})",
        R"(boundary[0]={on="top", rain=1e-6})",
        R"(boundary[0]={on="top", file="flood.csv"})",
        R"(well=[{on="left", rate=-1e-6}])",
        R"(well=[{on="drain", head=1e300}])",
        R"(wall=[{on="left"}, {on="pile", conductance=1e-8}])",
        R"(soil.specimen.retention={model="van-genuchten", alpha=2, n=1.6})",
        R"(soil.specimen.retention={model="gardner", alpha=1e300, residual_saturation=0.5})",
        R"(geometry={shape="box", width=1, depth=1, height=1})",
        R"(geometry={shape="box", width=1, depth=1e-3, height=1, layers={inflow=1, outflow=1}})",
        R"(mesh={size=0.5, structure="free"})",
        R"(boundary[2]={on="front", darcy_flux=1e-6})",
        R"(boundary[2]={on="back", seepage_face=true})",
        "gravity=[0, 0, -9.81]",
        "gravity=[1, 1, 1]",
        "output.probe=[{at=[0.5, 0.5, 0.5]}]",
        "soil.specimen.porosity_gradient=[0, 0, 0.01]",
        R"(gravity=[0, -9.81])",
        "initial={water_level=0.5}",
        "initial={water_level=-1e300}",
        "output.probe=[{at=[0.5, 0.5]}, {at=[1e300, 0]}]",
        "output.section=[{from=[0, 0], to=[1, 1]}, {from=[5, 5], to=[6, 6]}]"}) {
    all.push_back(entry);
  }
  return all;
}

std::vector<std::string> geometry_lines() {
  return {"Point(1)={0,0,0}; Point(2)={1,0,0}; Point(3)={1,1,0}; Point(4)={0,1,0};",
          "Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1};",
          "Curve Loop(1)={1,2,3,4}; Plane Surface(1)={1};",
          "Physical Surface(\"specimen\")={1};",
          "Physical Curve(\"top\")={3};",
          "Physical Point(\"well\")={1};",
          "SetFactory(\"OpenCASCADE\"); Rectangle(9)={0,0,0,1,1};",
          "Extrude {0,0,1} { Surface{1}; }",
          "Box(1)={0,0,0,1,1,1}; Physical Volume(\"specimen\")={1};",
          "SystemCall \"touch @/trace\";",
          "SystemCall Str(\"touch \", \"trace\");",
          "NonBlockingSystemCall \"rm @/canary\";",
          "System \"touch trace\";",
          "OnelabRun(\"a\", \"touch @/trace\");",
          "Solver.Executable0=\"touch @/trace\"; Solver.AutoMesh=1;",
          "Exec \"touch @/trace\";",
          "Merge \"@/evil.txt\";",
          "Include \"@/evil.txt\";",
          "Merge StrCat(\"@/ev\", \"il.txt\");",
          "MergeWithBoundingBox \"@/evil.txt\";",
          "ShapeFromFile(\"@/evil.txt\");",
          "Merge \"/etc/passwd\";",
          "Merge \"/dev/zero\";",
          "Merge \"@/fifo\";",
          "Merge \"@/a.geo\";",
          "Mesh 1; Mesh 2;",
          "Save \"@/trace.msh\";",
          "Save Sprintf(\"@/trace%g.pos\", 1);",
          "Print \"@/trace.png\";",
          "Print \"@/trace.msh\";",
          "Printf(\"alive\") > \"@/trace\";",
          "Printf(\"dead\") >> \"@/canary\";",
          "Error(\"\033[2J%g\", 1);",
          "CreateDir \"@/trace\";",
          "DeleteFile \"@/canary\";",
          "RenameFile {\"@/canary\", \"@/trace\"};",
          "UnlinkFile \"@/canary\";",
          "Field[1]=ExternalProcess; Field[1].CommandLine=\"touch @/trace\";",
          "Field[1]=Structured; Field[1].FileName=\"@/fifo\";",
          "Field[1]=Structured; Field[1].FileName=\"@/evil.txt\"; Field[1].TextFormat=1;",
          "Field[1]=MathEval; Field[1].F=\"0.1\";",
          "Background Field=1;",
          "Background Mesh View[0];",
          "Plugin(NewView).Run;",
          "Plugin(MathEval).Run;",
          "Plugin(AnalyseMeshQuality).Run;",
          "Plugin(Export).Run;",
          "Plugin(ExtractEdges).Run;",
          "Plugin(Probe).Run; Save View [0] \"@/trace.pos\";",
          "View \"v\" { SP(0,0,0){1}; };",
          "General.ErrorFileName=\"@/trace\"; General.OptionsFileName=\"@/trace\";",
          "General.SaveOptions=1; General.SaveSession=1; General.LogFileName=\"@/trace\";",
          "General.AbortOnError=0;",
          "General.AbortOnError=4;",
          "General.NumThreads=4;",
          "General.NumThreads=100000;",
          "Mesh.Algorithm3D=10; Mesh.MaxNumThreads3D=8;",
          "Mesh.Algorithm=8; Recombine Surface{1};",
          "Mesh.SecondOrderLinear=1; Mesh.ElementOrder=2;",
          "Sleep 10;",
          "SendToServer \"a\" {1};",
          "DefineConstant[ a = {1, Name \"a\", ServerAction \"touch @/trace\"} ];",
          "Exit;",
          "Abort;",
          "EndIf",
          "ElseIf(1)",
          "*/",
          "Return",
          "x[]={1:1000000};",
          "Delete Model; Delete Physicals;"};
}

Vocabulary case_vocabulary() {
  return vocabulary(case_seeds(), false);
}

Vocabulary results_vocabulary() {
  return vocabulary(results_seeds(), true);
}

}  // namespace suffuse::fuzz
