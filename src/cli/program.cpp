// Parses the command line, runs a verb, maps errors to exit codes.
#include <sunfleck/cli/program.hpp>

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <functional>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/input_file.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/core/version.hpp>

#include "cli/options.hpp"
#include "cli/standard_streams.hpp"
#include "cli/terminal_progress.hpp"

#ifndef SUNFLECK_LEFT_OUT
#define SUNFLECK_LEFT_OUT ""  // or " (without PART, ...)": parts that the build leaves out
#endif

namespace sunfleck {

namespace {

enum ExitCode { done = 0, failed = 1, bad_input = 2, stopped = 4 };  // 3, not as asked, is a verb's own answer

/// Options and what runs them, one per verb.
struct Verbs {
  SolveOptions solve;
  PlanOptions plan;
  CompareOptions compare;
  ExportOptions exporting;
  ImportOptions importing;
  RenderOptions render;
  PreviewOptions preview;
  ViewOptions view;
  GenerateOptions generate;
  InfoOptions info;
  OriginalsOptions originals;
  PolicyOptions policy;
};

std::string hint(const std::string& found, const std::vector<std::string>& known) {
  const std::string near = nearest_name(found, known);
  return near.empty() ? "" : "; did you mean '" + near + "'?";
}

/// Options of a verb by their long names.
std::vector<std::string> option_names(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options())
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

class Program {
 public:
  Program() {
    app_.set_version_flag("--version", "sunfleck " + software_version() + SUNFLECK_LEFT_OUT, "print the version and exit");
    app_.require_subcommand(1);
    app_.get_formatter()->label("SUBCOMMAND", "VERB");
    app_.set_help_flag("-h,--help", "print this help and exit");
    app_.footer(
        "Each verb has its own help: sunfleck VERB --help. Data go to standard output, progress and messages to standard error.\n"
        "Exit codes: 0 done, 1 output failed or not enough memory, 2 bad usage or input, 3 did not converge or is not as accurate as "
        "asked\n"
        "(the result is written, its status says which), 4 stopped.");
    add("solve", "the light that every facet and organ absorbs, into a result file", define_solve, verbs_.solve, verb_solve);
    add("plan", "what a solve would do and leave out, its memory and work, without solving", define_plan, verbs_.plan, verb_plan);
    add("compare", "the error of one result against another", define_compare, verbs_.compare, verb_compare);
    add("export", "a result as a lit mesh or a table", define_export, verbs_.exporting, verb_export);
    add("import", "a scene of AMAP (.ops) or CARIBU (.can, .opt, .light, .8) as a scene file", define_import, verbs_.importing,
        verb_import);
    add("render", "a picture of a result", define_render, verbs_.render, verb_render);
    add("preview", "a picture of a scene in a second, without a solve", define_preview, verbs_.preview, verb_preview);
    add("view", "an interactive viewer of a result, or of a scene before any, in the browser", define_view, verbs_.view, verb_view);
    add("info", "what a result, plant, species or scene file holds", define_info, verbs_.info, verb_info);
    add("originals", "which structures share an original, and its tables", define_originals, verbs_.originals, verb_originals);
    add("policy", "the policies in use, or one derived from the plants themselves", define_policy, verbs_.policy, verb_policy);
    add("generate", "a procedural plant from a species file", define_generate, verbs_.generate, verb_generate);
  }

  int run(int argc, char** argv) {
    if (argc < 2) {
      tell(app_.help());
      return bad_input;
    }
    if (argv[1][0] != '-' && std::find(names_.begin(), names_.end(), argv[1]) == names_.end()) {
      tell(fmt::format("sunfleck: unknown verb '{}'{}\nverbs: {}\n", argv[1], hint(argv[1], names_), joined(names_)));
      return bad_input;
    }
    try {
      app_.parse(argc, argv);
    } catch (const CLI::ExtrasError&) {
      return report_extras();
    } catch (const CLI::ParseError& error) {
      if (error.get_exit_code() == 0) return app_.exit(error);  // help or version, on standard output
      tell(fmt::format("sunfleck{}: {}\nsee 'sunfleck{} --help'\n", verb_suffix(), error.what(), verb_suffix()));
      return bad_input;
    }
    TerminalProgress progress;
    for (const auto& [verb, work] : work_)
      if (verb->parsed()) {
        if (verb->get_name() != "view") progress.end_when_overdue();  // to be stopped is how a viewer ends: it says goodbye by itself
        return work(progress);
      }
    return bad_input;
  }

 private:
  template <class Options>
  void add(const std::string& name, const std::string& text, void (*declare)(CLI::App&, Options&), Options& options,
           int (*work)(const Options&, Progress&)) {
    CLI::App* verb = app_.add_subcommand(name, text);
    verb->group("Verbs")->set_help_flag("-h,--help", "print this help and exit");
    declare(*verb, options);
    work_.emplace_back(verb, [work, &options](Progress& progress) { return work(options, progress); });
    names_.push_back(name);
  }

  const CLI::App* chosen() const {
    for (const auto& [verb, work] : work_)
      if (verb->parsed()) return verb;
    return nullptr;
  }
  std::string verb_suffix() const { return chosen() ? " " + chosen()->get_name() : ""; }

  int report_extras() const {
    const CLI::App* verb = chosen() ? chosen() : &app_;
    std::string text;
    for (const auto& extra : app_.remaining(true)) {
      const bool option = extra.size() > 1 && extra[0] == '-';
      text += fmt::format("sunfleck{}: {} '{}'{}\n", verb_suffix(), option ? "unknown option" : "unexpected argument", extra,
                          option ? hint(extra.substr(0, extra.find('=')), option_names(*verb)) : "");
    }
    tell(fmt::format("{}see 'sunfleck{} --help'\n", text, verb_suffix()));
    return bad_input;
  }

  CLI::App app_{"Sunfleck: the light that every leaf of a plant, crop or forest absorbs", "sunfleck"};
  Verbs verbs_;
  std::vector<std::pair<CLI::App*, std::function<int(Progress&)>>> work_;
  std::vector<std::string> names_;
};

constexpr const char* no_memory = "sunfleck: not enough memory; 'sunfleck plan' predicts what a scene needs\n";

int out_of_memory() {
  tell(no_memory);
  return failed;
}

/// Memory that a library, the standard one among them, did not get; also the stack of a thread, which comes as a thread that cannot be
/// started.
bool is_out_of_memory(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) || dynamic_cast<const OutOfMemory*>(&error)) return true;
  if (dynamic_cast<const Error*>(&error)) return false;  // says itself what it is
  if (const auto* system = dynamic_cast<const std::system_error*>(&error))
    return system->code() == std::errc::not_enough_memory || system->code() == std::errc::resource_unavailable_try_again;
  const std::string text = error.what();
  return text.find("pthread_create") != std::string::npos || text.find("ut of memory") != std::string::npos;
}

std::atomic<bool> working{false};

/// HDF5 (1.10.8) leaves the process by exit(-1) where it cannot have memory: no end for a program without a word.
void say_why_it_ends() {
  if (working) _exit(out_of_memory());
}

/// Where memory ends while an exception is on its way, or in a thread of a library, nobody can catch it any more.
[[noreturn]] void end_at_once() {
  const char* text = "sunfleck: ended by an error that nobody caught\n";
  if (const auto error = std::current_exception()) try {
      std::rethrow_exception(error);
    } catch (const std::exception& e) {
      if (is_out_of_memory(e)) text = no_memory;
    } catch (...) {
    }
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text, std::strlen(text));  // takes no memory
  std::_Exit(failed);
}

int guarded(int argc, char** argv) {
  try {
    const InputRecord what_is_read;
    return Program().run(argc, argv);
  } catch (const InputError& error) {
    tell(fmt::format("sunfleck: {}\n", error.what()));
    return bad_input;
  } catch (const UsageError& error) {
    tell(fmt::format("sunfleck: {}\n", error.what()));
    return bad_input;
  } catch (const Stopped& error) {
    tell(fmt::format("sunfleck: {}\n", error.what()));
    return stopped;
  } catch (const OutOfMemory& error) {
    tell(fmt::format("sunfleck: {}; 'sunfleck plan' predicts what a scene needs\n", error.what()));
    return failed;
  } catch (const std::exception& error) {
    if (is_out_of_memory(error)) return out_of_memory();
    tell(fmt::format("sunfleck: {}\n", error.what()));
    return failed;
  }
}

}  // namespace

int run_program(int argc, char** argv) {
  prepare_streams();
  std::atexit(say_why_it_ends);
  working = true;
  std::set_terminate(end_at_once);
  const int code = guarded(argc, argv);
  working = false;
  if (output_arrived()) return code;
  tell("sunfleck: standard output could not be written: what it was to hold is lost\n");
  return code == done ? failed : code;
}

}  // namespace sunfleck
