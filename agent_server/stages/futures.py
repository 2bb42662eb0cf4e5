"""From forecasts to several futures: others that may come, those of good quality alone."""

from collections.abc import Sequence

from agent_server.domain.model import Sampler
from agent_server.domain.motion import Forecast, Futures, Window
from agent_server.errors import InferenceError
from agent_server.skeleton.normalise import denormalise, normalise
from agent_server.stages.predict import hold_last


def draw_futures(
    sampler: Sampler,
    count: int,
    least_quality: float,
    windows: Sequence[Window],
    forecasts: Sequence[Forecast],
) -> list[Forecast]:
    """Put ``count`` - 1 drawn futures beside every forecast.

    A window at a time, so that no bit of a future depends on who else is there. A forecast that
    stands in for a failed one stays alone. Where the sampler fails, the last frame stands in, as
    where the predictor fails: a replay then does the same.

    Args:
        sampler: Draws them.
        count: Futures of a window, the forecast among them.
        least_quality: Drawn futures that are less probably real are left out.
        windows: What was seen.
        forecasts: What is expected, one a window.
    """
    return [
        _beside(sampler, count - 1, least_quality, window, forecast)
        for window, forecast in zip(windows, forecasts, strict=True)
    ]


def _beside(
    sampler: Sampler, count: int, least_quality: float, window: Window, forecast: Forecast
) -> Forecast:
    if forecast.failure is not None:
        return forecast
    seen, origin = normalise(window.positions)
    try:
        drawn, quality = sampler.draw(seen, count)
    except InferenceError as error:
        return hold_last(window, str(error))
    kept = quality >= least_quality
    positions, good = denormalise(drawn[kept], origin), quality[kept]
    for array in (positions, good):
        array.flags.writeable = False
    futures = Futures(positions, good, count, sampler.name)
    return Forecast(forecast.positions, forecast.source, futures=futures)
