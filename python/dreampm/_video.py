"""Who encodes films, where the package was built without an encoder."""
import os
import shutil


def find_ffmpeg() -> None:
    """Names the ffmpeg of imageio-ffmpeg to the library where there is none on the PATH."""
    if os.environ.get("DREAMPM_FFMPEG") or shutil.which("ffmpeg"):
        return
    try:
        import imageio_ffmpeg
    except ImportError:
        return  # make says what to install
    os.environ["DREAMPM_FFMPEG"] = imageio_ffmpeg.get_ffmpeg_exe()
