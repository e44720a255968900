// SPDX-License-Identifier: BSD-3-Clause
#include "formats.h"

#include <petzval/target/formats/polygon_file.h>
#include <petzval/target/formats/svg_shapes.h>
#include <petzval/target/visible_regions.h>

#include <cmath>

#include "cube_formats.h"
#include "glass_formats.h"
#include "lens_formats.h"
#include "live_format.h"
#include "raw_formats.h"
#include "require.h"
#include "scene_format.h"
#include "table_formats.h"

namespace petzval::fuzz {

namespace {

/// Polygons are refused, or make regions with finite corners.
template <typename Read>
bool try_target(std::string_view bytes, Read read) {
  TargetScene scene;
  if (!accepted([&] { validate(scene = read(std::string(bytes), "fuzz")); })) return false;
  require(!scene.polygons.empty(), "a scene without polygons");
  for (const Region& region : visible_regions(scene)) {
    require(std::isfinite(region.step), "a level that is not finite");
    for (const Contour& contour : region.contours)
      for (const Vertex& v : contour)
        require(std::abs(v.x) <= 2 * target_reach_px && std::abs(v.y) <= 2 * target_reach_px,
                "a corner out of reach");
  }
  return true;
}

}  // namespace

const std::vector<Format>& formats() {
  static const std::vector<Format> all{
      {"native",
       try_native,
       {"\"stop\": true", "\"glass\": \"F2\"", "\"conic\": -1", "\"asphere\": {\"4\": 1e-5}", "null",
        "\"nd\"", "\"index_table\"", "\"object_na\"", "\"radius_mm\"", "{}", "[]", "\\u0000"}},
      {"zmx",
       try_zmx,
       {"SURF 1\n", "  STOP\n", "  TYPE ODDASPHE\n", "  TYPE XASPHERE\n", "  TYPE XOSPHERE\n", "  XDAT 1 3\n",
        "  PARM 2 1e-5\n", "FLOA\n", "  DIAM 3 1\n", "  GLAS ___BLANK 1 0 1.6 40\n", "UNIT IN\n",
        "OBNA 0.1\n", "INFINITY", "  CONI -1\n", "PWAV 2\n", "FTYP 3 0 2 1\n", "\xFF\xFE", "MNUM 2\n"}},
      {"seq",
       try_seq,
       {"RDM\n",
        "RDM N\n",
        "STO\n",
        "ASP\n",
        "K -1\n",
        "J 1e-9\n",
        "CIR 3\n",
        "CIR EDG 3\n",
        "PIM\n",
        "DIM I\n",
        "NAO 0.1\n",
        "FNO 4\n",
        "PRV\n",
        "END\n",
        "PWL 500 600\n",
        "'G' 1.5 1.6\n",
        "517642",
        "500.700",
        "S3 ",
        "SI 0 0\n",
        "SPS ODD 2\n",
        "SCO AR3 1e-4\n",
        "SCO C31 0\n",
        "SCO NRADIUS 0.5\n",
        ";",
        "&\n",
        "!",
        "'",
        "REFL",
        "YIM 0 1\n",
        "REF 1\n"}},
      {"pbrt", try_pbrt, {"#", "0 1 0 5\n", "\t", "\n"}},
      {"iset",
       try_iset,
       {"\"ior\": 1.5", "\"radius\": 0", "\"surfaces\"", "{}", "[]", "null", "\"metadata\": {}"}},
      {"isettransfer",
       try_iset_transfer,
       {"\"coeff\": [1]", "\"termr\": 0", "\"radiiX\": [2, 2, 2]", "\"positions\": [0, 1, 2]",
        "\"polynomials\"", "{}", "[]", "null", "1e300", "-1"}},
      {"agf",
       try_agf,
       {"NM A 1 0 1.5 60 0 1\n", "NM A 13 0 1.5 60\n", "NM A 4 0 1.5 60\n", "CD 1 2 3\n", "LD 0.4 0.7\n",
        "IT 0.4 0 10\n", "\xFF\xFE", "OD - -\n"}},
      {"yaml",
       try_glass_yaml,
       {"  - type: formula 4\n", "  - type: tabulated nk\n", "    data: |\n", "formula 9", "formula 6",
        "DATA:\n", "&a ", "*a", "[", "{", "---\n", "    wavelength_range: 0.4 0.7\n", "n_is_absolute: true",
        "PROPERTIES:\n", "? "}},
      {"sensor",
       try_sensor,
       {"\"photosite\": {\"fill_factor\": 0.5},", "\"low_pass_um\": 2,", "\"serial\": 3,", "\"dark\": {}",
        "\"row_noise_e\": 1,", "{}", "[]", "null", "\"scale\": 0.5", "\"quantum_efficiency\": []"}},
      {"dng",
       try_dng,
       {std::string(4, '\xFF'), std::string(4, '\0'), std::string("\1\0\1\0", 4), std::string("\x8D\x82", 2),
        std::string("\x2C\xC6", 2), std::string("\x08\0", 2)}},
      {"polygons",
       [](std::string_view b) { return try_target(b, parse_polygons); },
       {"level 0.5\n", "ground 0\n", "hole 3 1 1 2 1 2 2\n", "#", "3 1 1 9 1 5 9\n", "99999999999", "\r",
        "\t"}},
      {"svg",
       [](std::string_view b) { return try_target(b, parse_svg_shapes); },
       {"<g>", "</g>", "<path d=\"M0 0h9v9z\"/>", "transform=\"scale(1e9)\"", "fill=\"none\"",
        "fill=\"#123\"", "rotate(30 1 2)", "A 3 4 5 0 1 6 7", "Z", "m", "&lt;", "<!--",
        "fill-rule=\"evenodd\"", "stroke=\"red\"", "<use href=\"#a\"/>", "%", "px"}},
      {"isetmat",
       try_iset_mat_table,
       {std::string(4, '\xFF'), std::string(4, '\0'), std::string("\x0E\0\0\0", 4),
        std::string("\x06\0\0\0", 4), "psf", "function", std::string("\0\0\0\0\0\0\xF8\x7F", 8)}},
      {"isetparms",
       try_isetparms,
       {"wave=400:50:700;", "imgHeight=[0 1 2];", "imgHeightNum=1e9;", "'", "%", "[", "]", ":", "Inf", "NaN",
        "\n", "psfSize=", "\xFF\xFE"}},
      {"listing",
       try_psf_listing,
       {"Values are normalized.\n", "Data spacing is 1 mm.\n", "Data area is ", "Image grid size: 9 by 9\n",
        "Center point is: row 2, column 3\n", "Center coordinates: 0, -1\n", "\t", "E+000", "\xFF\xFE",
        "nan"}},
      {"measured",
       try_measured,
       {"# focal_length_mm: 8\n", "# magnification: -0.1\n", "# object_distance_mm: 100\n", "field_mm",
        "frequency_cpmm", ",", ";", "\n", "0,550,", "1e-300", "-"}},
      {"kept", try_kept, {"null", "\"inf\"", "[]", "{}", "\"psf\":", "\"size\":", "1e400", "-1", ","}},
      {"scene",
       try_scene,
       {"AttributeBegin\n", "AttributeEnd\n", "\"float", "\"rgb L\" [ 1 2 3 ]", "]", "[", "\"", "#",
        "Shape \"sphere\"\n", "ObjectInstance \"o\"\n", "Material \"conductor\"\n",
        "Material \"coateddiffuse\"\n", "AreaLightSource \"diffuse\"\n", "Include \"fuzz.pbrt\"\n",
        "Scale 1e30 1 1\n", "Identity\n", "ReverseOrientation\n", "WorldBegin\n",
        "\"texture reflectance\" \"t\""}},
      {"gltf",
       try_gltf,
       {"\"mesh\":0,",
        "\"children\":[1]",
        "\"scale\":[1,1,1],",
        "\"byteStride\":4,",
        "\"mode\":5,",
        "\"sparse\":{\"count\":1},",
        "\"KHR_materials_volume\":{\"thicknessFactor\":1},",
        "\"camera\":0,",
        "\"material\":1,",
        "\"normalized\":true,",
        "\"uri\":\"data:,\"",
        "{}",
        "[]",
        "null",
        "[[[[",
        "\"extensions\":{}",
        std::string("JSON"),
        std::string("BIN\0", 4),
        std::string(4, '\xFF'),
        std::string(4, '\0')}},
      {"ply",
       try_ply,
       {"property float nx\n", "property list uchar int vertex_indices\n", "element face 1\n", "end_header\n",
        "comment\n", std::string(4, '\xFF'), std::string(4, '\0'), "uchar", "double", "obj_info\n", "\r"}},
      {"envi",
       try_envi,
       {"samples = 1\n",
        "lines = 1\n",
        "bands = 1\n",
        "data type = 12\n",
        "interleave = bil\n",
        "byte order = 1\n",
        "header offset = 1\n",
        "wavelength = {",
        "}",
        "wavelength units = um\n",
        "bbl = {1, 0}\n",
        "reflectance scale factor = 10\n",
        "data gain values = {1, 2}\n",
        "data units = W/m2/sr/nm\n",
        ";",
        "=",
        "{",
        "data ignore value = 0\n",
        "\nDATA\n",
        std::string("\0\0\xC0\x7F", 4)}},
      {"npy",
       try_npy,
       {"\"quantity\": \"reflectance\",", "\"quantity\": \"temperature\",", "\"quantity\": \"emissivity\",",
        "\"scale\": 1e-3,", "\"unit\": \"mW/cm2/sr/um\",", "null", "[]", "{}", "'<u2'", "'>f8'", "(2, 2)",
        "True", "\x93NUMPY", std::string("\0\0\xC0\x7F", 4)}},
      {"scenemat",
       try_scene_mat,
       {std::string(4, '\xFF'), std::string(4, '\0'), std::string("\x0E\0\0\0", 4),
        std::string("\x06\0\0\0", 4), "scene", "mcCOEF", "basis", "photons", "wave", "imgMean",
        std::string("\0\0\0\0\0\0\xF8\x7F", 8)}},
      {"mathdf5",
       [](std::string_view b) { return try_scene_mat_hdf5(b) || try_iset_mat_hdf5_table(b); },
       {std::string(4, '\xFF'), std::string(4, '\0'), std::string(8, '\xFF'), "TREE", "HEAP", "SNOD", "GCOL",
        "MATLAB_class", "MATLAB_empty", "double", "struct", "char", "photons",
        std::string("\0\0\0\0\0\0\xF8\x7F", 8)}},
      {"sceneexr",
       try_scene_exr,
       {std::string("Z\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0", 18), "sceneDepthFrom", "range",
        std::string("channels\0chlist\0", 16), std::string("S0.600,0nm\0", 11),
        std::string("T.600,0nm\0", 10), std::string("compression\0compression\0\1\0\0\0\3", 29),
        std::string("string\0", 7), std::string(4, '\xFF'), std::string(4, '\0'), "W.m^-2.nm^-1",
        std::string("\0\0\xC0\x7F", 4)}},
      {"png",
       try_photograph,
       {"IHDR", "PLTE", "IDAT", "IEND", "iCCP", "gAMA", "tRNS", "sRGB", "cHRM", std::string(4, '\xFF'),
        std::string(4, '\0')}},
      {"jpeg",
       try_photograph,
       {"\xFF\xD8", "\xFF\xD9", "\xFF\xC0", "\xFF\xC2", "\xFF\xC4", "\xFF\xDA", "\xFF\xDB", "\xFF\xDD",
        "\xFF\xE1", "\xFF\xE2", "Exif", "ICC_PROFILE", std::string("\xFF\0", 2)}},
      {"tiff",
       try_photograph,
       {std::string("II*\0", 4), std::string("MM\0*", 4), std::string("\x03\1\3\0\1\0\0\0\5\0\0\0", 12),
        std::string("\x12\1\3\0\1\0\0\0\6\0\0\0", 12), std::string(4, '\xFF'), std::string(4, '\0')}},
      {"live",
       try_live,
       {"\"kind\":\"state\",", "\"kind\":\"lens\",", "\"id\":1,", "null", "[]", "{}", "\"../../etc/passwd\"",
        "\"1.2m\"", "\"ev:12\"", "1e999", "\\u0000", std::string(4, '\xFF'), std::string(4, '\0')}},
      {"packed",
       try_packed,
       {"PZGLASS1", std::string(4, '\xFF'), std::string(4, '\0'), "\x80\x80\x80\x80\x80"}},
  };
  return all;
}

const Format* find_format(std::string_view name) {
  for (const Format& format : formats())
    if (format.name == name) return &format;
  return nullptr;
}

}  // namespace petzval::fuzz
