"""A run of images and odometry made from photographs, with its truth."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from tqdm import tqdm

from odometry.arrays import AnyArray, ByteImage, FloatArray
from odometry.io.files import atomic_write
from odometry.io.run_folder import write_run_folder
from odometry.parameters import write_parameters
from odometry.simulation.drive import Drive, simulate
from odometry.simulation.ground import GroundMap, to_world
from odometry.simulation.noise import ornstein_uhlenbeck
from terrain.camera.camera import Camera
from terrain.errors import SynthesisError
from terrain.synthesis.config import SynthesisConfig
from terrain.synthesis.photos import (
    Photo,
    built_in_photos,
    photos_from_folder,
    render_patches,
    write_patches,
)
from terrain.synthesis.records import identified_parameters, imu_table, motion_tables, run_settings
from terrain.synthesis.texture import Texture
from terrain.synthesis.view import Illumination, Scene, View, encode_jpeg, expose


def lay_out(
    config: SynthesisConfig, photos: Mapping[str, tuple[Photo, ...]], rng: np.random.Generator
) -> tuple[GroundMap, tuple[Texture, ...]]:
    """Ground of the run and the texture of each of its strips.

    The run starts at world x = 0, where the first zone begins; a zone whose terrain has several
    photographs is parted into as many strips.

    Raises
    ------
    SynthesisError
        If a zone names a terrain without photographs.
    """
    for zone in config.zones:
        if zone not in photos:
            raise SynthesisError(
                f"there are no photographs of {zone!r}; there are of: {', '.join(sorted(photos))}"
            )
    strips = [
        (zone, photo, config.zone_length_m / len(photos[zone]))
        for zone in config.zones
        for photo in photos[zone]
    ]
    lengths_m = np.array([length for _, _, length in strips])
    first, second = rng.uniform(0.0, 2 * np.pi, size=2)
    ground = GroundMap(
        np.cumsum(lengths_m)[:-1],
        tuple(zone for zone, _, _ in strips),
        config.edge_wave_m,
        (float(first), float(second)),
    )
    textures = tuple(
        Texture.laid_at_random(photo.image, config.metres_per_pixel, rng) for _, photo, _ in strips
    )
    return ground, textures


__all__ = ["SynthesisConfig", "synthesise"]


def synthesise(
    out: Path | str,
    config: SynthesisConfig | None = None,
    *,
    photos: Path | str | None = None,
    progress: bool = False,
) -> Path:
    """Make a run folder, `patches/` and `parameters.toml`, ready for `train` and `run`.

    A robot with other ICRs on every terrain is driven over zones of textured terrain, and
    its camera's view is rendered. The motion is integrated from velocity constraints (see
    `odometry.simulation`); no equation is shared with the estimators.

    Parameters
    ----------
    out : Path or str
        Folder to make; must be missing or empty.
    config : SynthesisConfig, optional
        What to make.
    photos : Path or str, optional
        Labelled photographs ``root/<class>/*.jpg|png``; grass, gravel and brick of scikit-image
        when absent. None of them shows in both the run and the patches.
    progress : bool
        Show a progress bar on stderr.

    Returns
    -------
    Path
        `out`. The same input gives the same bytes with the same versions of the libraries.

    Raises
    ------
    SynthesisError
        If `out` is not empty, the photographs do not suffice, or the camera shows no terrain.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import terrain
    >>> small = terrain.SynthesisConfig(zones=("grass",), zone_length_m=1.0, patches_per_terrain=2)
    >>> with TemporaryDirectory() as folder:
    ...     run = terrain.synthesise(f"{folder}/run", small)
    ...     print(sorted(file.name for file in run.iterdir() if file.is_dir()))
    ['images', 'patches']
    """
    out = Path(out)
    config = config or SynthesisConfig()
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise SynthesisError(f"{out} is there already and not an empty folder; choose another")
    streams = np.random.SeedSequence(config.seed).spawn(8)
    rngs = [np.random.default_rng(stream) for stream in streams]

    sets = built_in_photos() if photos is None else photos_from_folder(Path(photos), rngs[0])
    ground, textures = lay_out(config, sets.ground, rngs[1])
    icrs = config.true_icrs_m(sets.terrains)
    icrs_m = {name: icrs[name] for name in dict.fromkeys((*config.zones, *sets.terrains))}
    view = View.of(config.camera)
    patches = render_patches(config, view, sets.patches, rngs[5])
    write_patches(
        out / "patches", tqdm(patches, "patches", disable=None if progress else True), config
    )
    drive = _drive(config, ground, np.array([icrs_m[t] for t in ground.terrains]), rngs[2])
    tables = motion_tables(config, drive, rngs[3])
    if config.has_imu:
        tables["odometry"]["terrain"] = np.array(drive.terrains)
        tables["imu"] = imu_table(drive, tuple(icrs), rngs[7])

    shown = range(0, len(drive.stamps_s), config.samples_between("image_rate_hz"))
    tables["images"] = _images_table(drive, ground, config.camera, shown)
    frames = _frames(drive, shown, Scene(view, ground, textures), rngs[4])
    bar = tqdm(frames, "images", len(shown), disable=None if progress else True)
    for name, frame in zip(tables["images"]["file"], bar, strict=True):
        with atomic_write(out / str(name)) as part:
            part.write_bytes(encode_jpeg(frame, config.jpeg_quality))
    write_parameters(out / "parameters.toml", identified_parameters(config, icrs_m, rngs[6]))
    write_run_folder(out, run_settings(config, ground, icrs_m, sets.origin), tables)
    return out


def _drive(
    config: SynthesisConfig, ground: GroundMap, strip_icrs_m: FloatArray, rng: np.random.Generator
) -> Drive:
    """Drive from the start of the first zone to the end of the last one."""
    first, second, third = rng.uniform(0.0, 2 * np.pi, size=3)
    driver = replace(config.driver, phases_rad=(float(first), float(second), float(third)))
    length_m = config.zone_length_m * len(config.zones)
    step_s = 1.0 / config.odometry_rate_hz
    longest = int(np.ceil(4 * length_m / driver.speed_m_s / step_s))
    wander = ornstein_uhlenbeck(
        longest, step_s, np.array(config.icr_wander_m), config.icr_wander_time_s, rng
    )
    footprint_m = (float(config.robot["length"]), float(config.robot["width"]))
    return simulate(
        driver,
        ground,
        strip_icrs_m,
        footprint_m=footprint_m,
        step_s=step_s,
        disturbances_m=wander,
        end_x_m=length_m,
    )


def _frames(
    drive: Drive, shown: range, scene: Scene, rng: np.random.Generator
) -> Iterator[ByteImage]:
    """Images of the camera at the samples `shown`, under slowly changing light."""
    first, second = rng.uniform(0.0, 2 * np.pi, size=2)
    for k in shown:
        light = Illumination.at(drive.stamps_s[k], (float(first), float(second)))
        yield expose(scene.brightness(drive.poses_world[k]), light, rng)


def _images_table(
    drive: Drive, ground: GroundMap, camera: Camera, shown: range
) -> dict[str, AnyArray]:
    """Table images: the terrain is that at the image's centre."""
    centre = camera.pixels_to_ground((np.array(camera.image_size) - 1) / 2)
    seen = [ground.strip_at(to_world(drive.poses_world[k], centre)) for k in shown]
    return {
        "t": drive.stamps_s[shown],
        "file": np.array([f"images/{i:06d}.jpg" for i in range(len(shown))]),
        "terrain": np.array([ground.terrains[int(strip)] for strip in seen]),
    }
