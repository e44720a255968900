// SPDX-License-Identifier: BSD-3-Clause
// The petzval program: parses the command line and turns exceptions into exit codes.
#include "help.h"
#include "option_names.h"
#include "program.h"

#include <fmt/format.h>
#include <malloc.h>
#include <petzval/base/context.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/staged_files.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <new>

#include "interrupted.h"

namespace {

constexpr int ended_by_interrupt = 130;  // what shells expect of a program that Ctrl-C ends

int report(const std::string& message, int code) {
  fmt::print(stderr, "petzval: error: {}\n",
             petzval::app::with_option_names(petzval::with_final_names(message)));
  return code;
}

/// The data that is installed, or linked, beside this program.
void find_data() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error)
    petzval::set_default_data_directory((program.parent_path().parent_path() / "share" / "petzval").string());
}

}  // namespace

int main(int argc, char** argv) {
  using namespace petzval;
  find_data();
  // A limit on the size of files (ulimit -f) is a full disk like any other: an error, not a death by signal.
  std::signal(SIGXFSZ, SIG_IGN);
  app::stop_on_signals();
#ifdef __GLIBC__
  // Planes of large images come and go by the band: to hand each back to the system costs a quarter of the
  // time.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
  CLI::App program{"Petzval simulates a digital camera from the glass up.", "petzval"};
  app::Shared shared;
  std::vector<std::string> words = app::with_help_option({argv + 1, argv + argc});
  app::add_commands(program, shared, words);
  try {
    app::refuse_unknown_words(program, words);
    app::arrange_help(program, words);
    std::reverse(words.begin(), words.end());  // as CLI11 wants them
    program.parse(std::move(words));
    // Results on stdout are results: a full disk behind a pipe is a failure too.
    if (std::fflush(stdout) != 0) return report("standard output cannot be written", 1);
    return 0;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      const int code = program.exit(error);
      return std::cout.flush() ? code : report("standard output cannot be written", 1);
    }
    return report(app::usage_message(program, error), 2);
  } catch (const InputError& error) {
    return report(error.what(), 2);
  } catch (const app::Interrupted& stopped) {
    return report(stopped.what(), ended_by_interrupt);
  } catch (const Cancelled&) {
    return report("stopped; nothing was written", ended_by_interrupt);
  } catch (const Failure& error) {
    return report(error.what(), 1);
  } catch (const std::bad_alloc&) {
    return report("out of memory; a smaller picture or fewer bands would fit", 1);
  } catch (const std::exception& error) {
    return report(error.what(), 1);
  }
}
