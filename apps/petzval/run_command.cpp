// SPDX-License-Identifier: BSD-3-Clause
#include "run_command.h"

#include <petzval/base/context.h>
#include <petzval/base/staged_files.h>

#include <algorithm>
#include <new>

#include "field_option.h"
#include "option_names.h"
#include "program.h"

namespace petzval::app {

CommandOutcome run_command(std::vector<std::string> arguments, RenderSession* renders, SweepFrames* frames) {
  CLI::App program{"", "petzval"};
  Shared shared;
  shared.renders = renders;
  shared.frames = frames;
  add_commands(program, shared, arguments);
  const JsonTaker taker;
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
  try {
    program.parse(std::move(arguments));
  } catch (const Cancelled&) {
    throw;
  } catch (const CLI::ParseError& error) {
    return {2, {}, usage_message(program, error)};
  } catch (const InputError& error) {
    return {2, {}, with_option_names(with_final_names(error.what()))};
  } catch (const std::bad_alloc&) {
    return {1, {}, "out of memory; a smaller picture or fewer bands would fit"};
  } catch (const std::exception& error) {
    return {1, {}, with_final_names(error.what())};
  }
  return {0, taker.taken(), ""};
}

}  // namespace petzval::app
