# SPDX-License-Identifier: BSD-3-Clause
"""petzval focus on rendered scenes, against brute force."""

import resource
import unittest

from autofocus_scenes import SCENES, TRUTH, arguments, write_scenes
from petzval_cli import ProgramTest


class Autofocus(ProgramTest):
    def setUp(self):
        super().setUp()
        write_scenes(self.folder)

    def focus(self, name, *more):
        return self.json_of(*arguments(name, *more))

    def test_finds_what_brute_force_finds(self):
        """Within a tenth of the depth of focus (f-number x pixel), in 12 pictures or fewer, whatever the random numbers."""
        for seed, name in enumerate(SCENES, 1):
            with self.subTest(scene=name, seed=seed):
                found = self.focus(name, "--seed", seed)
                self.assertLessEqual(len(found["rows"]), 12)
                self.assertFalse(found["at_the_end"])
                self.assertAlmostEqual(found["film_distance_mm"], TRUTH[name], delta=0.1 * found["depth_mm"])

    def test_focuses_a_telephoto_in_less_than_twice_the_time_of_a_double_gauss(self):
        """Processor time of whole runs, the same zone of the same pixels, and camera rays."""

        def cost(name):
            before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            rays = self.focus(name, "--threads", 1)["camera_rays"]
            return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, rays

        near, telephoto = cost("near"), cost("telephoto")
        self.assertLess(telephoto[0], 2 * near[0])
        self.assertLess(telephoto[1], 2 * near[1])

    def test_takes_more_paths_where_the_measure_is_ragged(self):
        """Few pixels, and bright paths through a glass sphere: the ends of the range used to win.

        A scan of 13 places with 256 paths a pixel is within a fifth, two deviations of what counts as ragged, of its peak from 36.95 to
        39.90 mm."""
        for seed in (1, 3):
            with self.subTest(seed=seed):
                found = self.json_of("focus", "spheres", "--lens", "dgauss-50mm", "--size", "160x120", "--seed", seed, "--quiet")
                self.assertGreater(found["samples_per_pixel"], 16)
                self.assertLessEqual(found["noise"], 0.1)
                self.assertFalse(found["at_the_end"])
                self.assertGreater(found["film_distance_mm"], 36.95)
                self.assertLess(found["film_distance_mm"], 39.90)

    def test_refuses_to_answer_where_there_is_no_answer(self):
        self.assert_refused("focus", "spheres", "--lens", "dgauss-50mm", "--size", "160x120", "--focus-spp", "2", "--quiet",
                            words=("ragged", "--zone", "--focus-spp"))
        self.assert_refused(*arguments("near", "--focus-to", "40"), words=("the last of them", "--focus-to"))

    def test_the_search_of_2006_takes_more_pictures(self):
        baseline, found = self.focus("near", "--focus-search", "golden-2006"), self.focus("near")
        self.assertGreater(len(baseline["rows"]), len(found["rows"]))


if __name__ == "__main__":
    unittest.main()
