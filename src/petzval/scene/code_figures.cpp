// SPDX-License-Identifier: BSD-3-Clause
// Codes that machines read; the library zint knows how they are made.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/scene/chart_figures.h>
#include <zint.h>

#include <algorithm>
#include <memory>

namespace petzval {

namespace {

constexpr const char* usual_text = "PETZVAL 1840";

using Symbol = std::unique_ptr<zint_symbol, void (*)(zint_symbol*)>;

/// \throws InputError for a text that no code of the kind holds.
Symbol encoded(const char* name, int kind, const std::string& text) {
  Symbol symbol(ZBarcode_Create(), &ZBarcode_Delete);
  if (!symbol) throw Failure("too little memory for a code");
  constexpr int error_correction_m = 2;
  symbol->symbology = kind;
  symbol->input_mode = UNICODE_MODE;
  if (kind == BARCODE_QRCODE) symbol->option_1 = error_correction_m;
  if (kind == BARCODE_DATAMATRIX) symbol->option_3 = DM_SQUARE;
  const int status = ZBarcode_Encode(symbol.get(), reinterpret_cast<const unsigned char*>(text.c_str()),
                                     static_cast<int>(text.size()));
  if (status >= ZINT_ERROR)
    throw InputError(
        fmt::format("scene {}: a text of {} bytes does not fit into such a code; a shorter one would "
                    "be right",
                    name, text.size()));
  return symbol;
}

bool is_dark(const zint_symbol& symbol, int column, int row) {
  return (symbol.encoded_data[row][column / 8] >> (column % 8)) & 1;
}

/// The dark modules of a code within its quiet zone, as large as fits: a run in a row is one rectangle.
FigureChart code_figures(const char* name, int kind, int quiet_modules, ChartFrame frame,
                         const ChartParameter& parameter) {
  const Symbol symbol = encoded(name, kind, parameter.text.empty() ? usual_text : parameter.text);
  const int columns = symbol->width, rows = symbol->rows;
  const double module = frame.side() / (std::max(columns, rows) + 2 * quiet_modules);
  const double left = frame.centre().x - 0.5 * columns * module, top = frame.centre().y - 0.5 * rows * module;
  FigureChart chart;
  ChartFigure& dark = chart.figures.emplace_back();
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int begin = column;
      while (column < columns && is_dark(*symbol, column, row)) ++column;
      if (column == begin) continue;
      const double from = left + begin * module, to = left + column * module, y = top + row * module;
      dark.outlines.push_back({{from, y}, {to, y}, {to, y + module}, {from, y + module}});
    }
  return chart;
}

}  // namespace

FigureChart qr_figures(ChartFrame frame, const ChartParameter& text) {
  constexpr int quiet = 4;  // ISO/IEC 18004
  return code_figures("qr", BARCODE_QRCODE, quiet, frame, text);
}

FigureChart datamatrix_figures(ChartFrame frame, const ChartParameter& text) {
  constexpr int quiet = 2;  // ISO/IEC 16022 asks for one
  return code_figures("datamatrix", BARCODE_DATAMATRIX, quiet, frame, text);
}

}  // namespace petzval
