#include "drawing/png_file.hpp"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkPNGWriter.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

#include "common/errors.hpp"
#include "common/pending_file.hpp"

namespace suffuse {
namespace {

constexpr const char* signature = "\x89PNG\r\n\x1a\n";
constexpr std::size_t signature_size = 8;
constexpr std::size_t around_data = 12;  // length, type and checksum of a chunk

/// Big-endian, as all numbers of a PNG.
std::string bytes_of(std::uint32_t number, int count = 4) {
  std::string bytes;
  for (int k = count - 1; k >= 0; --k) {
    bytes += static_cast<char>(number >> static_cast<unsigned>(8 * k) & 0xFFU);
  }
  return bytes;
}

std::uint32_t number_at(const std::string& bytes, std::size_t place) {
  std::uint32_t number = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    number = number << 8U | static_cast<unsigned char>(bytes.at(place + k));
  }
  return number;
}

std::uint32_t checksum(const std::string& bytes) {
  const auto* first = reinterpret_cast<const Bytef*>(bytes.data());
  return static_cast<std::uint32_t>(crc32_z(0, first, bytes.size()));
}

struct Chunk {
  std::string type;
  std::string data;

  [[nodiscard]] std::string bytes() const {
    return bytes_of(static_cast<std::uint32_t>(data.size())) + type + data +
           bytes_of(checksum(type + data));
  }
};

std::vector<Chunk> read_chunks(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::vector<Chunk> chunks;
  std::size_t place = signature_size;
  const bool is_png = bytes.starts_with(std::string(signature, signature_size));
  while (is_png && place + around_data <= bytes.size()) {
    const std::size_t size = number_at(bytes, place);
    if (size > bytes.size() - place - around_data) break;
    chunks.push_back({bytes.substr(place + 4, 4), bytes.substr(place + 8, size)});
    place += around_data + size;
  }
  if (chunks.empty() || chunks.front().type != "IHDR" || chunks.front().data.size() != 13) {
    throw FileError(path + ": is no PNG");
  }
  return chunks;
}

/// The chunk before the data of a frame: its number among such chunks, its size, and how long it is
/// shown.
Chunk frame_control(std::uint32_t number, const std::string& size, int rate) {
  const std::string no_offset = bytes_of(0) + bytes_of(0);
  const std::string delay = bytes_of(1, 2) + bytes_of(static_cast<std::uint32_t>(rate), 2);
  const std::string replaces_all = bytes_of(0, 2);
  return {"fcTL", bytes_of(number) + size + no_offset + delay + replaces_all};
}

void enlarge(const std::string& path, const std::array<int, 2>& size) {
  vtkNew<vtkPNGReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkImageData& image = *reader->GetOutput();
  const int* old_size = image.GetDimensions();
  const int channels = image.GetNumberOfScalarComponents();
  vtkNew<vtkImageData> sheet;
  sheet->SetDimensions(size[0], size[1], 1);
  sheet->AllocateScalars(VTK_UNSIGNED_CHAR, channels);
  auto* white = static_cast<unsigned char*>(sheet->GetScalarPointer());
  std::fill_n(white, std::size_t{1} * size[0] * size[1] * channels, 255);
  const int beneath = size[1] - old_size[1];
  for (int row = 0; row < old_size[1]; ++row) {
    std::memcpy(sheet->GetScalarPointer(0, row + beneath, 0), image.GetScalarPointer(0, row, 0),
                std::size_t{1} * old_size[0] * channels);
  }
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(path.c_str());
  writer->SetInputData(sheet);
  writer->Write();
}

}  // namespace

std::array<int, 2> png_size(const std::string& path) {
  const std::string header = read_chunks(path).front().data;
  return {static_cast<int>(number_at(header, 0)), static_cast<int>(number_at(header, 4))};
}

void make_equal_size(const std::vector<std::string>& paths) {
  std::array<int, 2> largest{0, 0};
  for (const std::string& path : paths) {
    const auto size = png_size(path);
    for (int k = 0; k < 2; ++k) largest.at(k) = std::max(largest.at(k), size.at(k));
  }
  for (const std::string& path : paths) {
    if (png_size(path) != largest) enlarge(path, largest);
  }
}

void write_animated_png(const std::vector<std::string>& pictures, int rate,
                        const std::string& path) {
  PendingFile file(path);
  std::ofstream out(file.temporary_path(), std::ios::binary);
  const std::string header = read_chunks(pictures.front()).front().data;
  const std::string size = header.substr(0, 8);
  out << std::string(signature, signature_size) << Chunk{"IHDR", header}.bytes()
      << Chunk{"acTL", bytes_of(static_cast<std::uint32_t>(pictures.size())) + bytes_of(0)}.bytes();
  std::uint32_t number = 0;
  for (const std::string& picture : pictures) {
    const std::vector<Chunk> chunks = read_chunks(picture);
    if (chunks.front().data != header) throw FileError(picture + ": has another size or colours");
    out << frame_control(number++, size, rate).bytes();
    for (const Chunk& chunk : chunks) {
      if (chunk.type != "IDAT") continue;
      const bool first = &picture == &pictures.front();
      out << (first ? chunk : Chunk{"fdAT", bytes_of(number++) + chunk.data}).bytes();
    }
  }
  out << Chunk{"IEND", ""}.bytes() << std::flush;
  if (!out) throw FileError(path + ": could not be written whole; is the disk full?");
  file.commit();
}

}  // namespace suffuse
