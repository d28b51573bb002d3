"""Sun and sky by pvlib and Mitsuba, which know nothing of this project: prints a row of numbers a case.

Usage: independent_sky.py position|irradiance|sky      exit code 77: the library is not installed
"""
import math
import sys

SKIPPED = 77


def position():
    """year month day hour minute latitude longitude -> airless elevation and azimuth, NREL's algorithm."""
    try:
        import pandas
        from pvlib.solarposition import spa_python
    except ImportError:
        sys.exit(SKIPPED)
    for year, month, day, hour, minute, latitude, longitude in [
            (1950, 7, 15, 9, 30, 43.7, 7.27), (1999, 8, 11, 10, 45, 48.85, 2.35), (2010, 6, 21, 15, 54, 40.0, -105.0),
            (2015, 12, 4, 2, 0, -41.29, 174.77), (2019, 10, 5, 6, 15, 12.97, 77.59), (2024, 12, 21, 12, 0, 64.15, -21.94),
            (2045, 2, 1, 20, 20, 34.07, -118.24), (2080, 3, 20, 3, 40, 35.68, 139.69)]:
        when = pandas.DatetimeIndex([pandas.Timestamp(year, month, day, hour, minute, tz="UTC")])
        found = spa_python(when, latitude, longitude)
        print(year, month, day, hour, minute, latitude, longitude, found["elevation"].iloc[0], found["azimuth"].iloc[0])


def irradiance():
    """turbidity elevation -> direct normal and diffuse horizontal irradiance, Bird's clear sky."""
    try:
        from pvlib.atmosphere import get_relative_airmass
        from pvlib.clearsky import bird
    except ImportError:
        sys.exit(SKIPPED)
    for turbidity in (2.0, 2.5, 3.0):
        for elevation in (40.0, 60.0, 80.0):
            beta = 0.04608 * turbidity - 0.04586  # of the haze, at 1 micrometre
            sky = bird(90.0 - elevation, get_relative_airmass(90.0 - elevation), beta * 0.38**-1.3, beta * 0.5**-1.3, 2.0,
                       ozone=0.35, dni_extra=1361.0, asymmetry=0.85, albedo=0.0)
            print(turbidity, elevation, sky["dni"], sky["dhi"])


def sky():
    """turbidity sun's elevation, then elevation azimuth luminance of directions, the mean over the sky being 1: the model of
    Hosek and Wilkie."""
    try:
        import mitsuba
    except ImportError:
        sys.exit(SKIPPED)
    mitsuba.set_variant("scalar_rgb")
    for turbidity in (2.0, 3.0):
        for sun in (10.0, 40.0, 70.0):
            s = math.radians(sun)
            scene = mitsuba.load_dict({"type": "scene", "sky": {
                "type": "sunsky", "turbidity": turbidity, "sun_scale": 0.0, "albedo": 0.2,
                "sun_direction": [0.0, math.cos(s), math.sin(s)]}})

            def luminance(sine, azimuth):
                cosine = math.sqrt(1.0 - sine * sine)
                hit = mitsuba.SurfaceInteraction3f()
                hit.wi = mitsuba.Vector3f(-math.sin(azimuth) * cosine, -math.cos(azimuth) * cosine, -sine)
                colour = scene.environment().eval(hit)
                return 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2]

            total = sum(luminance(math.sqrt((j + 0.5) / 24), 2.0 * math.pi * (i + 0.5) / 48)
                        for j in range(24) for i in range(48)) / (24 * 48)
            for elevation in (10.0, 30.0, 50.0, 80.0):
                for azimuth in (0.0, 45.0, 90.0, 135.0, 180.0):
                    print(turbidity, sun, elevation, azimuth,
                          luminance(math.sin(math.radians(elevation)), math.radians(azimuth)) / total)


{"position": position, "irradiance": irradiance, "sky": sky}[sys.argv[1]]()
