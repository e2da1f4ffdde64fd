"""SHA-256 of every file that ``codes install`` may install, so that only reviewed files are run.

For CPython 3.11 and 3.12 on Linux x86_64, or any platform. For another pin: ``pip download --no-deps``, then
``sha256sum``.
"""

PLATFORMS = "CPython 3.11 and 3.12 on Linux x86_64"

HASHES: dict[str, tuple[str, ...]] = {
    "colorama==0.4.6": ("4f1d9991f5acc0ca119f9d443620b77f9d6b33703e51011c16baf57afb285fc6",),
    "ic-sharpy==2.4": ("c14917999e1ce5a0a3d32a3620ba85b553c96d87ff134d27d364997a10f33330",),
    "numpy==1.26.4": (
        "666dbfb6ec68962c033a450943ded891bed2d54e6755e35e5835d63f4f6931d5",
        "675d61ffbfa78604709862923189bad94014bef562cc35cf61d3a07bba02a7ed",
    ),
    "scipy==1.13.1": (
        "a78b4b3345f1b6f68a763c6e25c0c9a23a9fd0f39f5f3d200efe8feda560a5fa",
        "de3ade0e53bc1f21358aa74ff4830235d716211d7d077e340c7349bc3542e884",
    ),
    "wisdem==4.2.9": (
        "1da3b8c3a64af48d5b8be3b2b68a757a1dc061f5a4067ac173ce766fa50fb3ec",
        "f14d65b54acd141b0b818e05c7b2405f5a94b2192ea5129063c5fdb722068a45",
    ),
}


def requirements(pins: tuple[str, ...]) -> str:
    """The text of a requirements file for ``pip install --require-hashes``.

    Raises:
        KeyError: no hashes are available for a pin.
    """
    return "".join(f"{pin} {' '.join(f'--hash=sha256:{h}' for h in HASHES[pin])}\n" for pin in pins)
