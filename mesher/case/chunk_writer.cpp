#include "case/chunk_writer.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <vector>

namespace suffuse {
namespace {

// The bytes of numbers are written as they lie in memory.
static_assert(std::endian::native == std::endian::little);

/// The level that zlib calls its fastest.
constexpr int fast = 1;

/// Whether to compress these bytes would gain next to nothing: no value is frequent, and neighbours
/// differ. Looks at a thousand of them.
bool is_noise(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t samples = 1024;
  std::array<std::uint32_t, 256> counts{};
  std::uint64_t seen = 0;
  std::uint64_t repeated = 0;
  const std::size_t stride = std::max<std::size_t>(1, bytes.size() / samples);
  for (std::size_t i = 1; i < bytes.size(); i += stride) {
    ++counts[bytes[i]];
    ++seen;
    if (bytes[i] == bytes[i - 1]) ++repeated;
  }
  // Pairs of equal bytes: one of 256 where all values are equally frequent.
  std::uint64_t equal_pairs = 0;
  for (const std::uint64_t count : counts)
    equal_pairs += count * (count - std::min<std::uint64_t>(count, 1));
  return 128 * equal_pairs < seen * seen && 16 * repeated < seen;
}

/// Compresses one chunk after the other. To start zlib anew for each takes as long as a small
/// chunk.
class Compressor {
 public:
  Compressor() { works_ = deflateInit(&stream_, fast) == Z_OK; }
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;
  ~Compressor() {
    if (works_) deflateEnd(&stream_);
  }

  /// Numbers whose bytes are sorted: all first bytes, all second ones, and so on. Valid until the
  /// next call; empty where zlib fails.
  std::span<const std::uint8_t> compress(std::span<const std::uint8_t> sorted,
                                         std::size_t number_size) {
    if (!works_ || deflateReset(&stream_) != Z_OK) return {};
    // Room for the blocks of stored bytes, and for the ends of those before and behind.
    out_.resize(deflateBound(&stream_, sorted.size()) + sorted.size() / 1024 + 64 * number_size);
    stream_.next_out = out_.data();
    stream_.avail_out = static_cast<uInt>(out_.size());
    stream_.avail_in = 0;
    const std::size_t count = sorted.size() / number_size;
    for (std::size_t k = 0; k < number_size; ++k) {
      const auto bytes = sorted.subspan(k * count, count);
      set_level(is_noise(bytes) ? Z_NO_COMPRESSION : fast);
      // zlib does not write to what it reads.
      stream_.next_in = const_cast<std::uint8_t*>(bytes.data());
      stream_.avail_in = static_cast<uInt>(count);
      const bool last = k + 1 == number_size;
      const int status = deflate(&stream_, last ? Z_FINISH : Z_NO_FLUSH);
      if (status != (last ? Z_STREAM_END : Z_OK) || stream_.avail_in > 0) return {};
    }
    return {out_.data(), stream_.total_out};
  }

 private:
  void set_level(int level) {
    if (level == level_) return;
    deflateParams(&stream_, level, Z_DEFAULT_STRATEGY);
    level_ = level;
  }

  z_stream stream_{};
  int level_ = fast;
  bool works_ = false;
  std::vector<std::uint8_t> out_;
};

/// Column `column` from row `first` on, with its bytes sorted; zeros behind the last row.
void sort_bytes(const ChunkShape& shape, const std::uint8_t* numbers, std::size_t first,
                std::size_t column, std::vector<std::uint8_t>& sorted) {
  const std::size_t size = shape.number_size;
  const std::size_t count = std::min(shape.chunk_rows, shape.rows - first);
  if (count < shape.chunk_rows) std::ranges::fill(sorted, std::uint8_t{0});
  const std::uint8_t* from = numbers + (first * shape.columns + column) * size;
  for (std::size_t k = 0; k < size; ++k) {
    std::uint8_t* to = sorted.data() + k * shape.chunk_rows;
    const std::size_t stride = shape.columns * size;
    for (std::size_t i = 0; i < count; ++i) to[i] = from[i * stride + k];
  }
}

}  // namespace

ChunkShape chunk_shape(std::size_t rows, std::size_t columns, std::size_t number_size) {
  constexpr std::size_t most = std::size_t{1} << 19;
  return {rows, columns, std::min(rows, most), number_size};
}

bool write_chunks(hid_t set, const ChunkShape& shape, const std::uint8_t* numbers) {
  thread_local Compressor compressor;
  std::vector<std::uint8_t> sorted(shape.chunk_rows * shape.number_size);
  for (std::size_t first = 0; first < shape.rows; first += shape.chunk_rows) {
    for (std::size_t column = 0; column < shape.columns; ++column) {
      sort_bytes(shape, numbers, first, column, sorted);
      const auto bytes = compressor.compress(sorted, shape.number_size);
      if (bytes.empty()) return false;
      const std::array<hsize_t, 2> offset{first, column};
      if (H5Dwrite_chunk(set, H5P_DEFAULT, 0, offset.data(), bytes.size(), bytes.data()) < 0) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace suffuse
