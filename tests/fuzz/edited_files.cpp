#include "edited_files.hpp"

#include <hdf5.h>

#include "bytes.hpp"
#include "common/scratch_folder.hpp"
#include "file_edits.hpp"

namespace suffuse::fuzz {
namespace {

constexpr const char* hdf5_signature = "\x89HDF";

std::string scratch_folder() {
  static const ScratchFolder scratch("suffuse-fuzz");
  return scratch.path().string();
}

}  // namespace

std::string lay_out_case(const std::string& input) {
  const std::string folder = scratch_folder();
  if (input.starts_with(hdf5_signature)) {
    lay_out({{case_file, input}}, folder);
  } else {
    lay_out(case_seeds().at(seed_of(input, names(case_seeds()))), folder);
    apply_edits(input, folder, case_file);
  }
  return folder + "/" + case_file;
}

std::string lay_out_results(const std::string& input) {
  const std::string folder = scratch_folder();
  lay_out(results_seeds().at(seed_of(input, names(results_seeds()))), folder);
  apply_edits(input, folder, "run.json");
  return folder;
}

void forget_files() {
  H5Eclear2(H5E_DEFAULT);
  if (H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_ALL) > 0) H5close();
}

}  // namespace suffuse::fuzz
