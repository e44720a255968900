# SPDX-License-Identifier: BSD-3-Clause
"""Digital-camera simulation from the glass up (docs/PYTHON.md).

    import petzval as pz
    camera = pz.Camera("edmund-54852", f_number=2.8, focus="1.2m", sensor="example-vga")
    light = camera.image("studio")               # SpectralImage
    picture = pz.develop(camera.expose(light))   # Picture

Lengths in mm, wavelengths in nm, pixel pitches in um, angles in degrees: each name says its unit.
"""

from pathlib import Path as _Path

from ._errors import CallError, Cancelled, Error, Failure, InputError, Note
from ._petzval import (Camera, Clip, Edge, Edges, FirstOrder, Flare, FocusRun, Frame, GainMode, Glass, GlassCatalogue,
                       ImagePlan, ImagingSession, Lens, LensDataTable, LensFacts, LensOnSensor, Picture,
                       PictureDifference, PsfStack, PupilData, Raw, Rendering, Scene, SceneRequest, Sensor, SensorTest,
                       SpectralImage, Sun, Surface, SurfaceList, TableCamera)
from ._tables import Analysis, Events, Table, TracedRays
from . import _keywords, _petzval

_keywords.explain(_petzval)  # before its functions are taken

from ._petzval import (analyses, bundled_names, chart_names, compare, compare_lenses, data_directory, develop,
                       list_unsupported, match_lenses, measure_colour, measure_oecf, merge_images, merge_renderings, render_frames, set_data_directory, sfr, target,
                       target_chart_names, test_sensor)
from ._petzval import _set_default_data_directory, _version
from ._sweep import sweep

__version__ = _version()
_set_default_data_directory(str(_Path(__file__).parent / "share" / "petzval"))

__all__ = [name for name in dir() if not name.startswith("_")] + ["__version__"]
