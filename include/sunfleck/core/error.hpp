// Typed errors. The library throws them and never exits; the command line maps them to exit codes.
#pragma once

#include <stdexcept>
#include <string>

namespace sunfleck {

/// Any error that the program explains to its user.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Bad input: what() reads "WHERE: found FOUND; expected EXPECTED" where WHERE is "file", "file:line" or "file:line: key".
/// Exit code 2.
class InputError : public Error {
 public:
  using Error::Error;
  InputError(const std::string& where, const std::string& found, const std::string& expected);
};

/// A call that cannot be right (unknown option, wrong suffix of an output file). Exit code 2.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// Output could not be written (disk full, no permission); nothing that existed is lost. Exit code 1.
class OutputError : public Error {
 public:
  using Error::Error;
};

/// Memory that is not there, or would not be: what() reads "not enough memory for WHAT". The program says the same, with the same exit code
/// 1, where a library finds none (cli/program.cpp).
class OutOfMemory : public Error {
 public:
  explicit OutOfMemory(const std::string& what) : Error("not enough memory for " + what) {}
};

/// The user asked to stop (a signal, or Progress::cancelled). Exit code 4.
class Stopped : public Error {
 public:
  Stopped();
};

/// "FILE" / "FILE:LINE" / "FILE:LINE: KEY" for an InputError; line 0 and an empty key are left out.
std::string location(const std::string& file, long line = 0, const std::string& key = {});

}  // namespace sunfleck
