// SPDX-License-Identifier: BSD-3-Clause
// Glass: what C++ calls Material, and catalogues of it.
#include "glass.h"

#include <petzval/glass/dispersion.h>
#include <petzval/glass/glass_file.h>

namespace petzval::python {

namespace {

using Pairs = std::vector<std::pair<double, double>>;

using GlassFields = std::tuple<std::string, std::string, int, Numbers, std::pair<double, double>, Pairs,
                               Pairs, std::optional<double>, std::optional<double>, std::string, bool, bool>;

GlassFields fields_of(const Glass& g) {
  return {g.catalogue,
          g.name,
          g.formula,
          g.coefficients,
          {g.shortest_nm, g.longest_nm},
          g.n_table,
          g.k_table,
          g.stated_nd,
          g.stated_vd,
          g.status,
          g.absolute,
          g.vacuum_wavelengths};
}

Glass glass_of(const GlassFields& f) {
  const auto& [catalogue, name, formula, coefficients, range, n, k, nd, vd, status, absolute, vacuum] = f;
  return {catalogue, name, formula, coefficients, range.first, range.second, n,
          k,         nd,   vd,      status,       absolute,    vacuum};
}

/// What a material is made of, for pickle: nothing (air), a glass, a model, an index, or a table.
using State = std::tuple<int, std::optional<GlassFields>, std::array<double, 3>, Pairs>;

State state_of(const Material& material) {
  const Material::Kind& kind = material.kind();
  State state{static_cast<int>(kind.index()), {}, {}, {}};
  if (const auto* glass = std::get_if<std::shared_ptr<const Glass>>(&kind))
    std::get<1>(state) = fields_of(**glass);
  if (const auto* model = std::get_if<Material::Model>(&kind))
    std::get<2>(state) = {model->nd, model->vd, model->dpgf};
  if (const auto* constant = std::get_if<Material::Constant>(&kind))
    std::get<2>(state) = {constant->index, 0, 0};
  if (const auto* table = std::get_if<Material::Table>(&kind)) std::get<3>(state) = *table;
  return state;
}

Material material_of(const State& state) {
  const auto& [kind, glass, numbers, table] = state;
  switch (kind) {
    case 1:
      return Material(std::make_shared<const Glass>(glass_of(glass.value())));
    case 2:
      return Material(Material::Model{numbers[0], numbers[1], numbers[2]});
    case 3:
      return Material(Material::Constant{numbers[0]});
    case 4:
      return Material(table);
    default:
      return {};
  }
}

Material tabulated(const Numbers& wavelengths_nm, const Numbers& indices) {
  if (wavelengths_nm.size() != indices.size())
    throw InputError(fmt::format("{} wavelengths and {} indices; as many of both would be right",
                                 wavelengths_nm.size(), indices.size()));
  Pairs table;
  for (std::size_t i = 0; i < indices.size(); ++i) table.emplace_back(wavelengths_nm[i], indices[i]);
  return Material(table);
}

AbbeNumbers abbe(const Material& material) {
  return abbe_numbers([&](double wavelength_nm) { return material.index(wavelength_nm); });
}

nb::object index_at(const Material& material, const nb::object& wavelength_nm) {
  if (PyFloat_Check(wavelength_nm.ptr()) || PyLong_Check(wavelength_nm.ptr()))
    return nb::float_(material.index(nb::cast<double>(wavelength_nm)));
  Numbers indices;
  for (const double each : nb::cast<Numbers>(wavelength_nm)) indices.push_back(material.index(each));
  return nb::cast(array_of(std::move(indices)));
}

}  // namespace

Material material_from(const nb::object& glass) {
  if (glass.is_none()) return {};
  if (nb::isinstance<nb::str>(glass)) {
    const auto name = nb::cast<std::string>(glass);
    return name == "air" ? Material() : glass_material(name);
  }
  return nb::cast<Material>(glass);
}

void bind_glass(nb::module_& module) {
  nb::class_<Material>(
      module, "Glass",
      "What fills the gap behind a surface. Indices are relative to air at 20 degrees C and 1 atm.")
      .def(
          "__init__",
          [](Material* self, const std::string& name) {
            new (self) Material(material_from(nb::str(name.c_str())));
          },
          nb::arg("name"),
          "A glass of the bundled catalogue, \"SCHOTT:N-BK7\" or \"N-BK7\", or \"air\". Raises InputError, "
          "naming the nearest.")
      .def_static(
          "model",
          [](double nd, double vd, double dpgf) {
            return Material(Material::Model{nd, vd, dpgf});
          },
          nb::arg("nd"), nb::arg("vd"), nb::arg("dpgf") = 0.0,
          "A glass known by nd and Vd alone (Conrady's formula).")
      .def_static(
          "constant", [](double index) { return Material(Material::Constant{index}); }, nb::arg("index"),
          "The same index at every wavelength.")
      .def_static("table", tabulated, nb::arg("wavelengths_nm"), nb::arg("indices"),
                  "Indices at increasing wavelengths [nm], a monotone cubic in between.")
      .def_prop_ro("name", &Material::description, "\"SCHOTT:N-BK7\", \"air\", \"nd 1.6 Vd 60\".")
      .def_prop_ro("is_air", &Material::is_air)
      .def_prop_ro(
          "nd", [](const Material& m) { return abbe(m).nd; }, "Index at 587.56 nm.")
      .def_prop_ro(
          "vd", [](const Material& m) { return abbe(m).vd; }, "Abbe number; infinite without dispersion.")
      .def("index", index_at, nb::arg("wavelength_nm"),
           "Refractive index at a wavelength [nm], or an array of it for a sequence. Raises InputError where "
           "it is not known.")
      .def("extinction", &Material::extinction, nb::arg("wavelength_nm"),
           "Extinction coefficient k, or None where no data says.")
      .def("__repr__", [](const Material& m) { return "Glass('" + m.description() + "')"; })
      .def("__getstate__", state_of)
      .def("__setstate__",
           [](Material& self, const State& state) { new (&self) Material(material_of(state)); })
      .def("__eq__", [](const Material& a, const nb::object& b) {
        return nb::isinstance<Material>(b) && state_of(a) == state_of(nb::cast<const Material&>(b));
      });

  nb::class_<GlassCatalogue>(module, "GlassCatalogue",
                             "Glasses by name: the bundled ones, and your own before them.")
      .def(
          "__init__",
          [](GlassCatalogue* self, const std::vector<std::string>& paths) {
            std::vector<Glass> own;
            for (const std::string& path : paths)
              for (Glass& glass : read_glass_files(path).glasses) own.push_back(std::move(glass));
            new (self) GlassCatalogue(GlassCatalogue::bundled().with(std::move(own)));
          },
          nb::arg("paths") = std::vector<std::string>(),
          "The bundled glasses, and before them those of .agf and .yml files or folders of them.")
      .def("names", &GlassCatalogue::full_names, "\"CATALOGUE:NAME\" of every glass, sorted.")
      .def("__len__", &GlassCatalogue::size)
      .def("__contains__", &GlassCatalogue::contains)
      .def("__getitem__",
           [](const GlassCatalogue& self, const std::string& name) { return glass_material(name, self); })
      .def("__repr__", [](const GlassCatalogue& self) {
        return fmt::format("<GlassCatalogue of {} glasses>", self.size());
      });
}

}  // namespace petzval::python
