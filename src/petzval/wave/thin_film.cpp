// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/wave/thin_film.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

using Complex = std::complex<double>;

/// n cos θ behind Snell's law, of the wave that goes onwards: it decays where it cannot travel.
Complex normal_index(Complex index, double tangential_index) {
  const Complex root = std::sqrt(index * index - tangential_index * tangential_index);
  return root.imag() > 0 || (root.imag() == 0 && root.real() < 0) ? -root : root;
}

/// Optical admittance, tangential H over tangential E, in units of free space's.
Complex admittance(Complex index, Complex normal, Polarisation polarisation) {
  return polarisation == Polarisation::s ? normal : index * index / normal;
}

/// Admittances in front and behind, and tangential E and H in front where E behind is 1.
struct FilmFields {
  Complex first, last, e, h;
};

FilmFields film_fields(double index_before, std::span<const ThinFilm> films, double index_after,
                       double cosine, double wavelength_nm, Polarisation polarisation) {
  constexpr Complex i{0, 1};
  const double tangential = index_before * std::sqrt(std::max(0.0, 1 - cosine * cosine));
  FilmFields fields;
  fields.first = admittance(index_before, index_before * cosine, polarisation);
  fields.last = admittance(index_after, normal_index(index_after, tangential), polarisation);
  fields.e = 1, fields.h = fields.last;
  for (std::size_t k = films.size(); k-- > 0;) {
    const Complex normal = normal_index(films[k].index, tangential);
    const Complex eta = admittance(films[k].index, normal, polarisation);
    const Complex phase = 2 * pi * normal * films[k].thickness_nm / wavelength_nm;
    const Complex c = std::cos(phase), s = std::sin(phase);
    const Complex before = c * fields.e + i * s * fields.h / eta;
    fields.h = i * eta * s * fields.e + c * fields.h;
    fields.e = before;
  }
  return fields;
}

}  // namespace

FilmPower film_power(double index_before, std::span<const ThinFilm> films, double index_after, double cosine,
                     double wavelength_nm, Polarisation polarisation) {
  const auto [first, last, e, h] =
      film_fields(index_before, films, index_after, cosine, wavelength_nm, polarisation);
  const Complex sum = first * e + h;
  return {std::norm((first * e - h) / sum), 4 * first.real() * last.real() / std::norm(sum)};
}

std::complex<double> film_amplitude(double index_before, std::span<const ThinFilm> films, double index_after,
                                    double cosine, double wavelength_nm, Polarisation polarisation) {
  const auto [first, last, e, h] =
      film_fields(index_before, films, index_after, cosine, wavelength_nm, polarisation);
  return 2 * std::sqrt(first.real() * std::max(0.0, last.real())) / (first * e + h);
}

}  // namespace petzval
