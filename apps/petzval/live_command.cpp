// SPDX-License-Identifier: BSD-3-Clause
// petzval live: the bench in a browser.
#include <fmt/format.h>
#include <petzval/lens/lens_file.h>
#include <petzval/live/bench_scene.h>
#include <petzval/live/guard.h>
#include <petzval/live/live_server.h>
#include <petzval/sensor/sensor.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "command.h"
#include "interrupted.h"
#include "page_opener.h"

namespace petzval::app {

namespace {

struct LiveChoice {
  LensChoice lens;
  std::string scene = "studio", sensor;
  unsigned short port = 0;
  bool no_open = false, end_with_page = false, check = false;
};

/// A file that was named at the start is offered by its name alone.
std::string label_of(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

LiveOptions live_options(LiveChoice& choice, const Shared& shared) {
  if (choice.lens.path_or_name.empty()) choice.lens.path_or_name = "dgauss-50mm";
  LiveOptions options;
  LiveStart& start = options.start;
  start.lens_name = choice.lens.path_or_name;
  start.lens_json = lens_to_json(choice.lens.read(shared));
  const LiveNames names = bundled_live_names();
  const auto is_bundled = [](const std::vector<std::string>& all, const std::string& name) {
    return std::find(all.begin(), all.end(), name) != all.end();
  };
  start.scene = choice.scene;
  if (!is_bundled(names.scenes, choice.scene)) {
    start.scene = label_of(choice.scene);
    start.scene_files[start.scene] = bench_scene(choice.scene);  // refuses what is none
  }
  start.sensor = choice.sensor;
  if (!choice.sensor.empty() && !is_bundled(names.sensors, choice.sensor)) {
    read_sensor(choice.sensor);
    start.sensor = label_of(choice.sensor);
    start.sensor_files[start.sensor] = choice.sensor;
  }
  options.port = choice.port;
  if (choice.port != 0) options.token = kept_token(choice.port);
  options.end_with_page = choice.end_with_page;
  return options;
}

void live(LiveChoice choice, const Shared& shared) {
  LiveServer server(live_options(choice, shared));
  fmt::print("{}\n", server.url());
  if (choice.check) return;
  if (!shared.quiet)
    fmt::print("The bench is open at this address, for this machine alone; Ctrl-C ends it.\n");
  std::fflush(stdout);
  PageOpener opener;
  if (!choice.no_open && !opener.open(server.url()))
    note(shared, "no browser could be opened; open the address yourself");
  try {
    server.run(context_of(shared));
  } catch (const Cancelled&) {
    throw Interrupted("the bench is closed; what was not saved is gone");
  }
}

}  // namespace

void add_live_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<LiveChoice>();
  CLI::App* command =
      add_command(app, shared, "live", "Open the bench in a browser: move a lens, see the picture",
                  "petzval live dgauss-50mm --scene studio --check", false,
                  [options, &shared] { live(*options, shared); });
  options->lens.add_to(*command, true, false);
  command
      ->add_option("--scene", options->scene,
                   "What is before the lens at first: a chart's name, a photograph or a "
                   "spectral file")
      ->capture_default_str();
  command->add_option(
      "--sensor", options->sensor,
      "What is behind it at first: a file or a name; default: a bundled one that the lens covers");
  command
      ->add_option("--port", options->port,
                   "Of 127.0.0.1; 0: one that is free. A page that is open finds a server "
                   "that is started again on the same port")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command->add_flag("--no-open", options->no_open, "Prints the address and opens no browser");
  command->add_flag("--end-with-page", options->end_with_page, "Ends when the last page is closed");
  command->add_flag("--check", options->check,
                    "Reads everything, tries the port, prints the address and ends");
}

}  // namespace petzval::app
