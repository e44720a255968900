# SPDX-License-Identifier: BSD-3-Clause
# LibRaw, the reader of raw files that others use, holds our DNG files to what it makes of them.
petzval_import(petzval_libraw::libraw libraw/libraw.h raw_r)
target_link_libraries(test_sensor PRIVATE petzval_libraw::libraw)
