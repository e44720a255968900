// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/sensor/sensor.h>
#include <petzval/sensor/sensor_reader.h>

#include <cmath>

#include "scratch.h"

namespace petzval {
namespace {

class SensorFile : public ::testing::Test {
 protected:
  std::string write(const std::string& text) { return scratch_.with("sensor.json", text); }
  std::string message_of(const std::string& text) {
    try {
      read_sensor(write(text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

 private:
  const test::Scratch scratch_;
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const char* good = R"({"format": "petzval-sensor/1", "name": "n", "source": "s",
  "columns": 30,
  "rows": 20, "pitch_um": 2.5})";

std::string good_with(const std::string& from, const std::string& to) {
  std::string text = good;
  return text.replace(text.find(from), from.size(), to);
}

TEST(SensorGeometry, PaperSensorIsAThirdOfAnInch) {
  // Maeda, Catrysse and Wandell 2005: 768 x 576 pixels of 6.25 µm are 4.8 mm x 3.6 mm, 6 mm in diagonal
  // (exact in decimal; the tolerance is rounding).
  const SensorGeometry sensor = read_sensor("third-inch-768x576").geometry;
  EXPECT_EQ(sensor.columns, 768);
  EXPECT_EQ(sensor.rows, 576);
  EXPECT_NEAR(sensor.width_mm(), 4.8, 1e-14);
  EXPECT_NEAR(sensor.height_mm(), 3.6, 1e-14);
  EXPECT_NEAR(sensor.half_diagonal_mm(), 3.0, 1e-14);
}

TEST(SensorGeometry, InvertsTheRealImage) {
  const SensorGeometry sensor{4, 2, 10};
  // Upright storage: column 0 is at +x' of the inverted image, row 0 (top) at -y'.
  EXPECT_DOUBLE_EQ(sensor.x_mm(0.5), 0.015);
  EXPECT_DOUBLE_EQ(sensor.x_mm(3.5), -0.015);
  EXPECT_DOUBLE_EQ(sensor.y_mm(0.5), -0.005);
  EXPECT_DOUBLE_EQ(sensor.y_mm(1.5), 0.005);
}

TEST(ReadSensor, TakesAGeometryInWords) {
  const Sensor sensor = read_sensor("768x576@6.25");
  EXPECT_EQ(sensor.geometry.columns, 768);
  EXPECT_EQ(sensor.geometry.rows, 576);
  EXPECT_EQ(sensor.geometry.pitch_um, 6.25);
}

TEST(ReadSensor, RefusesBadGeometries) {
  for (const char* text : {"0x576@6.25", "768x-1@6.25", "768x576@0", "768x576@-3", "768x576@nan",
                           "768x576@inf", "768x576@", "x@", "@", "768@6.25", "768x576@6.25um",
                           "99999999999x2@1", "900000x2@1", "", "no-such-sensor", "/", "768x576@6@7"})
    EXPECT_THROW(read_sensor(text), InputError) << text;
}

TEST(ReadSensor, NamesTheNearestBundledOnes) {
  try {
    read_sensor("full-frame-24");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(contains(error.what(), "full-frame-24mp")) << error.what();
  }
}

TEST_F(SensorFile, IsRead) {
  const Sensor sensor = read_sensor(write(good));
  EXPECT_EQ(sensor.name, "n");
  EXPECT_EQ(sensor.source, "s");
  EXPECT_EQ(sensor.geometry.columns, 30);
  EXPECT_EQ(sensor.geometry.rows, 20);
  EXPECT_EQ(sensor.geometry.pitch_um, 2.5);
}

TEST_F(SensorFile, UnknownKeyIsAnErrorOnItsLine) {
  const std::string message = message_of(good_with("\"rows\"", "\"rowz\""));
  EXPECT_TRUE(contains(message, ":3: ")) << message;
  EXPECT_TRUE(contains(message, "rowz")) << message;
}

TEST_F(SensorFile, WrongValuesAreNamedWithTheirLine) {
  for (const char* value : {"30.5", "\"30\"", "null", "-3", "0", "1e300", "900000", "99999999999999999999"}) {
    const std::string message = message_of(good_with("30", value));
    EXPECT_TRUE(contains(message, ":2: ") && contains(message, "columns")) << value << ": " << message;
  }
  for (const char* value : {"0", "-1", "1e9", "\"2.5\"", "[2.5]"}) {
    const std::string message = message_of(good_with("2.5", value));
    EXPECT_TRUE(contains(message, ":3: ")) << value << ": " << message;
  }
}

TEST_F(SensorFile, MissingKeyIsNamed) {
  EXPECT_TRUE(contains(message_of(good_with(", \"source\": \"s\"", "")), "has no \"source\""));
}

TEST_F(SensorFile, OtherFormatsAreRefused) {
  EXPECT_TRUE(contains(message_of(good_with("sensor/1", "sensor/2")), "petzval-sensor/1"));
  for (const char* text : {"", "[]", "3", "{", "null", "\xff\xfe", "{\"format\": 3}"})
    EXPECT_NE(message_of(text), "no error") << text;
}

TEST_F(SensorFile, EveryTruncationIsAnError) {
  const std::string whole = good;
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_NE(message_of(whole.substr(0, length)), "no error") << length;
}

TEST(BundledSensors, AreReadable) {
  const auto names = bundled_names("sensors", ".json");
  EXPECT_GE(names.size(), 4u);
  for (const std::string& name : names) {
    const Sensor sensor = read_sensor(name);
    EXPECT_FALSE(sensor.name.empty()) << name;
    EXPECT_FALSE(sensor.source.empty()) << name;
  }
}

TEST(SensorSettings, AlterEntriesOfTheFile) {
  const Sensor sensor = read_sensor("third-inch-1280x960", {"pitch_um=5", "gain_modes[0].read_noise_e=1.5"});
  EXPECT_EQ(sensor.geometry.pitch_um, 5);
  EXPECT_EQ(sensor.geometry.columns, 1280);
  EXPECT_EQ(sensor.require_electronics().gain_modes[0].read_noise_e, 1.5);
  EXPECT_EQ(read_sensor("768x576@6.25", {"columns=100"}).geometry.columns, 100);
  EXPECT_EQ(read_sensor("768x576@6.25", std::vector<std::string>{}).geometry.columns, 768);
}

TEST(SensorSettings, AreCheckedAsTheFileIs) {
  for (const std::string wrong : {"pitch_um=-1", "pitch=3", "pitch_um", "gain_modes[9].read_noise_e=1", "=3",
                                  "columns=1.5", "gain_modes[0].read_noise_e=low", "name.first=x"})
    try {
      read_sensor("third-inch-1280x960", {wrong});
      ADD_FAILURE() << wrong;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(wrong), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace petzval
