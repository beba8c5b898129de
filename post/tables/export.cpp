#include "tables/export.hpp"

#include <vtkErrorCode.h>
#include <vtkHDFReader.h>
#include <vtkNew.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <filesystem>
#include <fstream>

#include "common/errors.hpp"
#include "common/pending_file.hpp"
#include "drawing/vtk_messages.hpp"
#include "files/number_text.hpp"
#include "values/snapshot_choice.hpp"

namespace suffuse {
namespace {

namespace fs = std::filesystem;

void convert(const std::string& from, const std::string& to) {
  PendingFile file(to);
  const VtkMessages messages;
  vtkNew<vtkHDFReader> reader;
  reader->SetFileName(from.c_str());
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputConnection(reader->GetOutputPort());
  writer->SetFileName(file.temporary_path().c_str());
  const bool written = writer->Write() == 1;
  if (writer->GetErrorCode() != vtkErrorCode::NoError) {
    throw FileError(to + ": could not be written whole; is the disk full?");
  }
  messages.throw_errors(to);
  if (!written) throw FileError(to + ": cannot be written");
  file.commit();
}

std::vector<std::string> kinds_of(const ResultsReader& results) {
  std::vector<std::string> kinds{"mesh", "solid"};
  if (results.scene().scene.formulation == Formulation::double_point) kinds.emplace_back("liquid");
  return kinds;
}

/// Reads from every snapshot, before anything is written. A damaged one throws FileError with its
/// name here; VTK's messages about it would name neither the file nor the fault.
void check_snapshots(const ResultsReader& results) {
  for (std::size_t i = 0; i < results.times().size(); ++i) {
    for (const auto& kind : kinds_of(results)) {
      static_cast<void>(results.field_names(i, kind == "mesh" ? "cell" : kind));
    }
  }
}

void export_kind(const ResultsReader& results, const std::string& kind, const fs::path& folder) {
  std::string entries;
  for (std::size_t i = 0; i < results.times().size(); ++i) {
    const fs::path source = results.snapshot_path(kind, i);
    const std::string name = source.stem().string() + ".vtu";
    convert(source.string(), (folder / name).string());
    entries += "    <DataSet timestep=\"" + number_text(results.times()[i]) +
               "\" part=\"0\" file=\"" + name + "\"/>\n";
  }
  const std::string path = (folder / (kind + ".pvd")).string();
  PendingFile file(path);
  std::ofstream out(file.temporary_path());
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n"
      << entries << "  </Collection>\n</VTKFile>\n"
      << std::flush;
  if (!out) throw FileError(path + ": could not be written whole; is the disk full?");
  file.commit();
}

}  // namespace

void export_vtu(const ResultsReader& results, const std::string& folder) {
  expect_snapshots(results);
  check_snapshots(results);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError(folder + ": cannot be made: " + error.message());
  for (const auto& kind : kinds_of(results)) export_kind(results, kind, folder);
}

}  // namespace suffuse
