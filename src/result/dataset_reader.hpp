// Reading datasets of files that may be damaged or hostile.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <sunfleck/core/h5.hpp>

namespace sunfleck::h5 {

/// Every failure is an InputError that names file and dataset.
class DatasetReader {
 public:
  explicit DatasetReader(const std::string& path);

  const std::string& path() const { return path_; }
  bool has(const std::string& name) const;
  std::vector<std::size_t> shape(const std::string& name) const;
  /// Throws unless the dataset has this shape.
  void expect(const std::string& name, const std::vector<std::size_t>& wanted) const;

  /// The block of rows [first, first + count) along dimension `axis`; dimensions before it are fixed at `outer`.
  template <class T>
  std::vector<T> block(const std::string& name, const std::vector<std::size_t>& outer, std::size_t first, std::size_t count) const;
  template <class T>
  std::vector<T> all(const std::string& name) const;
  std::vector<std::string> strings(const std::string& name) const;

  bool has_attribute(const std::string& object, const char* name) const;
  std::string text_attribute(const std::string& object, const char* name) const;
  std::uint64_t count_attribute(const std::string& object, const char* name) const;
  std::vector<double> values_attribute(const std::string& object, const char* name) const;

  /// Throws InputError about a dataset of this file.
  [[noreturn]] void fail(const std::string& name, const std::string& found, const std::string& expected) const;

 private:
  struct Dataset {
    Id id;
    std::vector<std::size_t> dims;
    H5T_class_t type;
    std::size_t element_size;
  };
  const Dataset& open(const std::string& name) const;
  Id attribute(const std::string& object, const char* name) const;

  std::string path_;
  Id file_;
  mutable std::map<std::string, Dataset> open_;
};

/// "4 x 2 x 3"
std::string shape_text(const std::vector<std::size_t>& dims);

}  // namespace sunfleck::h5
