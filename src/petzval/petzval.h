// SPDX-License-Identifier: BSD-3-Clause
// Everything that a program needs to go from a lens to a picture (docs/CPP.md).
#pragma once

// What is given: lens, glass, scene, sensor.
#include <petzval/glass/catalogue.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens.h>
#include <petzval/lens/lens_file.h>
#include <petzval/optics/table_file.h>
#include <petzval/scene/scene_file.h>
#include <petzval/sensor/sensor.h>

// The lens by itself, and the three steps of a camera: light on the sensor, a raw image, a picture.
#include <petzval/simulate/analysis.h>
#include <petzval/simulate/camera.h>
#include <petzval/simulate/camera_table.h>
#include <petzval/simulate/clip.h>
#include <petzval/simulate/develop.h>
#include <petzval/simulate/expose.h>
#include <petzval/simulate/image.h>
#include <petzval/simulate/imaging_session.h>
#include <petzval/simulate/outputs.h>
#include <petzval/simulate/psf_stack.h>
#include <petzval/simulate/render.h>
#include <petzval/simulate/target.h>
#include <petzval/simulate/vibration.h>

// The lens as it is built, and a better one.
#include <petzval/optimise/fit_build.h>
#include <petzval/optimise/optimise.h>
#include <petzval/tolerance/tolerancing.h>

// How work is done, and what goes wrong.
#include <petzval/base/context.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/version.h>
