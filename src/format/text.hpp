// Text files read whole and cut into lines and words, with the line number at hand for messages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

/// The bytes of a file. InputError if it is missing, a folder, or cannot be read.
std::string read_whole(const std::string& file);

/// Text without its byte-order mark; UTF-16 and UTF-32, known by their mark or by the zeros of the first sign, become UTF-8. Other bytes
/// stay as they are. InputError naming the file where they are no such text.
std::string without_mark(std::string bytes, const std::string& file);

/// Bytes of a named character set as UTF-8. InputError(where) if there is no such set, or they are not of it.
std::string from_charset(std::string_view bytes, const std::string& charset, const std::string& where);

/// A text file as UTF-8, without a byte-order mark. Bytes that are no UTF-8 are taken for Windows-1252, with a note that says so.
std::string read_text(const std::string& file, std::vector<std::string>& notes);

/// InputError unless the file exists and is not a folder.
void check_readable(const std::string& file);

/// Lines of a text, without "\n" or "\r\n". A line that ends with a backslash goes on in the next one where `continues` says so of it.
class Lines {
 public:
  using Continues = bool (*)(std::string_view line);
  explicit Lines(std::string_view text, Continues continues = nullptr) : text_(text), continues_(continues) {}
  bool next(std::string_view& line);
  /// Number of the (first part of the) line last returned, from 1.
  long number() const { return first_; }
  /// Bytes consumed so far.
  std::size_t offset() const { return at_; }

 private:
  bool raw(std::string_view& line);
  std::string_view text_;
  std::size_t at_ = 0;
  long line_ = 0, first_ = 0;
  Continues continues_;
  std::string joined_;
};

/// Words of a line, separated by blanks; empty when there are no more.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}
  std::string_view next();
  /// All that is left, without blanks around it.
  std::string_view rest();

 private:
  std::string_view rest_;
};

/// Cells of a line between commas, without blanks around them.
std::vector<std::string_view> cells_of(std::string_view line);

/// Rows of a list of names (empty so far) by name, appended if new: Plant's own look-ups are linear, which a file with 10^5 names would
/// feel.
class NameIndex {
 public:
  explicit NameIndex(std::vector<std::string>& names) : names_(names) {}
  std::uint32_t operator()(const std::string& name) {
    const auto [at, fresh] = index_.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
    if (fresh) names_.push_back(name);
    return at->second;
  }

 private:
  std::vector<std::string>& names_;
  std::unordered_map<std::string, std::uint32_t> index_;
};

/// The whole word as a number, rounded correctly; "nan" and "inf" are numbers here. False if it is none.
bool to_number(std::string_view word, double& value);
bool to_integer(std::string_view word, std::int64_t& value);

/// Three finite coordinates from the next words, or InputError for that line.
Vec3 read_point(Words& words, const std::string& file, long line, const char* what);

/// "\"word\"" for messages, as UTF-8, shortened where it is long and with control characters replaced.
std::string in_quotes(std::string_view word);

}  // namespace sunfleck
