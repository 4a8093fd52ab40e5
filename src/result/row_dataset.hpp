// Datasets that are filled row by row, compressed by worker threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <libdeflate.h>
#include <tbb/enumerable_thread_specific.h>

#include "result/output_file.hpp"

namespace sunfleck::h5 {

/// Chunks that wait to be compressed. HDF5 compresses under one global lock; here all chunks of a batch are shuffled and deflated
/// in parallel (libdeflate writes zlib's format in a third of zlib's time) and then written as they are, in the order in which they
/// came: the same file for any number of threads.
class ChunkQueue {
 public:
  explicit ChunkQueue(OutputFile& file) : file_(file) {}
  void add(hid_t dataset, std::span<const hsize_t> offset, std::size_t element_size, std::vector<char> bytes);
  void flush();

 private:
  struct Chunk {
    hid_t dataset;
    std::vector<hsize_t> offset;
    std::size_t element_size;
    std::vector<char> bytes;
    std::uint32_t skipped_filters = 0;
  };
  void compress(Chunk& chunk);

  OutputFile& file_;
  struct FreeCompressor {
    void operator()(libdeflate_compressor* c) const;
  };
  std::vector<Chunk> chunks_;
  std::size_t bytes_ = 0;
  tbb::enumerable_thread_specific<std::unique_ptr<libdeflate_compressor, FreeCompressor>> compressors_;
};

/// Shape [outer][rows][inner...], where outer (lighting states) may be left out. Small datasets are written in one piece.
/// Rows that are never appended read as zeros and take no room.
class RowDataset {
 public:
  struct Shape {
    std::size_t outer = 0;  ///< 0 = no such dimension
    std::size_t rows = 0;
    std::vector<std::size_t> inner;
  };
  RowDataset(OutputFile& file, ChunkQueue& queue, hid_t parent, const std::string& name, hid_t type, const Shape& shape,
             std::string_view unit);

  /// `count` next rows of one outer index.
  void append(std::size_t outer, const void* rows, std::size_t count);
  /// Hands over what is left. The dataset must live until the queue is flushed.
  void finish();
  hid_t id() const { return dataset_.get(); }

 private:
  void write_chunk(std::size_t outer);

  OutputFile& file_;
  ChunkQueue& queue_;
  Id dataset_;
  Shape shape_;
  hid_t type_;
  std::size_t element_size_, row_bytes_, chunk_rows_;
  bool chunked_;
  std::vector<std::vector<char>> pending_;  ///< per outer index
  std::vector<std::size_t> written_rows_;   ///< per outer index
};

/// A text attribute, UTF-8.
void write_attribute(OutputFile& file, hid_t object, const char* name, const std::string& text);
void write_attribute(OutputFile& file, hid_t object, const char* name, std::uint64_t value);
void write_attribute(OutputFile& file, hid_t object, const char* name, const std::vector<double>& values);
Id make_group(OutputFile& file, hid_t parent, const char* name);
Id open_or_make_group(OutputFile& file, hid_t parent, const char* name);
/// UTF-8 string type for texts up to `length` bytes, or H5T_VARIABLE.
Id string_type(std::size_t length);

/// Writes whole arrays; keeps their datasets open until flush().
class ArrayWriter {
 public:
  ArrayWriter(OutputFile& file, ChunkQueue& queue) : file_(file), queue_(queue) {}
  /// dims[0] is the row dimension.
  template <class T>
  void write(hid_t group, const char* name, const T* data, const std::vector<std::size_t>& dims, std::string_view unit) {
    write_raw(group, name, memory_type<T>(), data, {0, dims.at(0), {dims.begin() + 1, dims.end()}}, unit);
  }
  /// dims[0] counts lighting states, dims[1] is the row dimension.
  template <class T>
  void write_states(hid_t group, const char* name, const T* data, const std::vector<std::size_t>& dims, std::string_view unit) {
    write_raw(group, name, memory_type<T>(), data, {dims.at(0), dims.at(1), {dims.begin() + 2, dims.end()}}, unit);
  }
  template <class T>
  void write(hid_t group, const char* name, const std::vector<T>& data, std::string_view unit) {
    write(group, name, data.data(), {data.size()}, unit);
  }
  void write_strings(hid_t group, const char* name, const std::vector<std::string>& texts);
  void flush();

 private:
  void write_raw(hid_t group, const char* name, hid_t type, const void* data, const RowDataset::Shape& shape, std::string_view unit);

  OutputFile& file_;
  ChunkQueue& queue_;
  std::vector<RowDataset> open_;
};

}  // namespace sunfleck::h5
