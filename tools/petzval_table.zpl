! SPDX-License-Identifier: BSD-3-Clause
! Writes the lens at hand as text files for `petzval optics import DIR --from zemax` (docs/TABLES.md): ISETPARMS.TXT,
! <base>_DI_.dat, <base>_RI_.dat and <base>_2D_PSF_Fld<i>_Wave<j>.dat.
!
! Before: give every surface its clear aperture, and save settings of the Huygens PSF window: linear, not normalised,
! not "use centroid", wavelength 2, field 1. Spacing and samples of the PSFs are what is saved there.

! ---- what to write, and where ----
FOLDER$ = "C:\PETZVAL\"
BASE$ = "LENS"
SETTINGS$ = "HPS.CFG"
WAVES = 7
FIRST_NM = 400
LAST_NM = 700
HEIGHTS = 13
LARGEST_MM = 3.0

! ---- the lens as it stands ----
LENS$ = $FILEPATH()
NAME$ = $FILENAME()
GETSYSTEMDATA 1
EFL = VEC1(7)
N_INFINITY = VEC1(8)
N_WORKING = VEC1(10)
MAGNIFICATION = VEC1(16)
OBJECT_MM = THIC(0)
PRIMARY_NM = 1000 * WAVL(PWAV())
! Half the field, seen from the entrance pupil, from the chief ray of the largest height.
NUMFIELD 1
SETSYSTEMPROPERTY 100, 2
FLDX 1 = 0
FLDY 1 = LARGEST_MM
SETAIM 2
UPDATE
RAYTRACE 0, 1, 0, 0, PWAV()
HALF_FIELD = ACOS(RAYN(0)) * 180 / 3.14159265358979

PRINT "Petzval: writing to ", FOLDER$
PARAMETERS$ = FOLDER$ + "ISETPARMS.TXT"
OUTPUT PARAMETERS$
LINE$ = "lensFile='" + NAME$ + "';"
PRINT LINE$
LINE$ = "baseLensFileName='" + BASE$ + "';"
PRINT LINE$
FORMAT 1.0
PRINT "imgHeightNum=", HEIGHTS, ";"
FORMAT .9 EXP
PRINT "imgHeightMax=", LARGEST_MM, ";"
PRINT "wave=", FIRST_NM, ":", (LAST_NM - FIRST_NM) / (WAVES - 1), ":", LAST_NM, ";"
PRINT "objDist=", OBJECT_MM, ";"
PRINT "mag=", MAGNIFICATION, ";"
PRINT "refWave=", PRIMARY_NM, ";"
PRINT "fov=", HALF_FIELD, ";"
PRINT "efl=", EFL, ";"
PRINT "fnumber_eff=", N_WORKING, ";"
PRINT "fnumber=", N_INFINITY, ";"
OUTPUT SCREEN

! ---- chief rays: a row a height, a column a wavelength ----
! Heights are paraxial at the primary wavelength, which stays: so all wavelengths see one object point.
IMAGE = NSUR()
NUMWAVE 2
WAVL 1 = PRIMARY_NM / 1000
PWAV 1
FILE$ = FOLDER$ + BASE$ + "_DI_.dat"
OUTPUT FILE$
FORMAT .9 EXP
FOR I = 1, HEIGHTS, 1
  FLDY 1 = (I - 1) / (HEIGHTS - 1) * LARGEST_MM
  FOR J = 1, WAVES, 1
    WAVL 2 = (FIRST_NM + (J - 1) * (LAST_NM - FIRST_NM) / (WAVES - 1)) / 1000
    SETVIG
    UPDATE
    ! At the axis the field is 0 and has no direction: its height is 0.
    Y = 0
    IF (I > 1)
      RAYTRACE 0, 1, 0, 0, 2
      Y = RAYY(IMAGE)
    ENDIF
    IF (J < WAVES) THEN PRINT Y, " ",
    IF (J == WAVES) THEN PRINT Y
  NEXT
NEXT
OUTPUT SCREEN

! ---- relative illumination, which is that of the primary wavelength: one at a time ----
NUMWAVE 1
PWAV 1
NUMFIELD 2
FLDX 2 = 0
FILE$ = FOLDER$ + BASE$ + "_RI_.dat"
OUTPUT FILE$
FORMAT .9 EXP
FOR I = 1, HEIGHTS, 1
  FOR J = 1, WAVES, 1
    WAVL 1 = (FIRST_NM + (J - 1) * (LAST_NM - FIRST_NM) / (WAVES - 1)) / 1000
    FLDY 1 = 0
    FLDY 2 = (I - 1) / (HEIGHTS - 1) * LARGEST_MM
    SETVIG
    UPDATE
    BRIGHTNESS = 1
    IF (I > 1) THEN BRIGHTNESS = RELI(2)
    IF (J < WAVES) THEN PRINT BRIGHTNESS, " ",
    IF (J == WAVES) THEN PRINT BRIGHTNESS
  NEXT
NEXT
OUTPUT SCREEN

! ---- PSFs, the field at -y ----
NUMFIELD 1
NUMWAVE 2
WAVL 1 = PRIMARY_NM / 1000
PWAV 1
FOR I = 1, HEIGHTS, 1
  FLDY 1 = -(I - 1) / (HEIGHTS - 1) * LARGEST_MM
  FOR J = 1, WAVES, 1
    WAVL 2 = (FIRST_NM + (J - 1) * (LAST_NM - FIRST_NM) / (WAVES - 1)) / 1000
    SETVIG
    UPDATE
    FORMAT 1.0
    FILE$ = FOLDER$ + BASE$ + "_2D_PSF_Fld" + $STR(I) + "_Wave" + $STR(J) + ".dat"
    GETTEXTFILE FILE$, Hps, SETTINGS$, 1
  NEXT
NEXT

LOADLENS LENS$
PRINT "Petzval: done"
