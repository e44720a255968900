// SPDX-License-Identifier: BSD-3-Clause
// petzval demo: the 2005 paper, figure by figure, in one folder.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/version.h>
#include <petzval/lens/lens_file.h>

#include <filesystem>
#include <memory>

#include "command.h"
#include "demo/demo.h"
#include "output_option.h"

namespace petzval::app {

namespace {

struct DemoCommand {
  std::string folder = "demo-pictures";
  std::string scene = "studio";
};

/// The folder of the pictures: one that exists is used, and files in it of the same names are replaced; one
/// that was made for pictures that then failed is taken away again.
class PictureFolder {
 public:
  explicit PictureFolder(const std::string& folder) : folder_(folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw InputError(folder, fmt::format("cannot be made a folder: {}", error.message()));
  }
  ~PictureFolder() {
    std::error_code not_empty;
    std::filesystem::remove(folder_, not_empty);
  }
  PictureFolder(const PictureFolder&) = delete;
  PictureFolder& operator=(const PictureFolder&) = delete;

 private:
  std::string folder_;
};

void run_demo(const DemoCommand& options, const Shared& shared) {
  const PictureFolder folder(options.folder);
  StagedFiles files;
  ProgressBar bar(!shared.quiet);
  Demo demo{options.folder,
            files,
            options.scene,
            read_lens("edmund-54852").lens,
            read_lens("fisheye-10mm").lens,
            html::Page("Lens design inside camera simulation",
                       "The figures of Maeda, Catrysse & Wandell (2005), made again from the prescription"),
            {}};
  demo.page.add(
      html::paragraph("Every number and picture below comes from the lens prescription by `petzval demo`: "
                      "real rays, aimed at the real "
                      "stop, summed to irradiance and diffraction PSFs, then used to turn spectral radiance "
                      "into sensor irradiance. "
                      "Beside each figure: what the paper reports, and what is found here."));

  // The share of the time that each section takes, for the progress bar.
  double begun = 0;
  const auto section = [&](double share, const auto& work) {
    demo.progress = [&bar, begun, share](double fraction, const std::string& what) {
      bar.update(begun + share * fraction, what);
    };
    work();
    begun += share;
  };
  LensDataTable table;
  section(0.05, [&] {
    TableOptions table_options;
    table_options.wavelengths_nm = {paper_wavelength_nm};
    table_options.field_count = 21;
    table_options.max_image_height_mm = third_inch_sensor.half_diagonal_mm();
    table = build_lens_data_table(demo.edmund, table_options, demo.progress);
  });
  section(0.01, [&] { layout_section(demo); });
  section(0.01, [&] { distortion_section(demo, table); });
  section(0.08, [&] { illumination_section(demo, table); });
  section(0.05, [&] { psf_section(demo); });
  section(0.05, [&] { checkerboard_section(demo, table); });
  section(0.50, [&] { multispectral_section(demo); });
  section(0.25, [&] { altered_lens_section(demo); });
  demo.page.footer(
      fmt::format("petzval {} · Maeda, Catrysse & Wandell, Integrating lens design with digital camera "
                  "simulation, Proc. SPIE 5678 (2005)",
                  version()));
  demo.write("index.html", demo.page.html());
  files.commit();
  fmt::print("{}\n", (std::filesystem::absolute(options.folder) / "index.html").lexically_normal().string());
}

}  // namespace

void add_demo_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<DemoCommand>();
  CLI::App* command =
      add_command(app, shared, "demo", "The 2005 paper again, figure by figure, into one folder",
                  "petzval demo -o demo-pictures", false, [=, &shared] { run_demo(*options, shared); });
  command->add_option("-o,--output", options->folder, "Folder to write; index.html opens offline")
      ->check(output_folder())
      ->capture_default_str();
  command->add_option("--scene", options->scene, "Scene of the multispectral figures: a chart or a file")
      ->capture_default_str();
}

}  // namespace petzval::app
