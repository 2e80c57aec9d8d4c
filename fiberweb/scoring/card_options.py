"""How a score card is made: the options of `card`, and a part of the config's section."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from fiberweb.model.scene import Positive
from fiberweb.scoring.limits import ALPHA, HORIZON, SPLIT
from fiberweb.scoring.tasks import ORDERS
from fiberweb.sections import Section, key

Part = Annotated[float, Field(ge=0, lt=1)]
Fraction = Annotated[float, Field(gt=0, lt=1)]

# What others did, by name; a key that is given wins.
RECIPES = {
    # The physical-reservoir competition PHRESCO 2026: least squares, the first fifth dropped. Its
    # script scales markers and targets over the whole record, test part included; least squares
    # gives the same estimates whatever the scale, so nothing of that is left to repeat.
    "phresco": {
        "amplitude": 0.5, "washout": 0.2, "split": 0.8, "alpha": 1e-9, "taps": 10, "bar": 0.2,
    },
}  # fmt: skip


class CardOptions(Section):
    """How a recording is scored."""

    recipe: Literal[tuple(RECIPES)] | None = key(None, "what others did, instead of the defaults")
    rate: Positive | None = key(
        None, "rate to thin the recording to, which it divides; null keeps all frames", "Hz"
    )
    washout: Part = key(0.0, "first part of the recording that is not scored")
    split: Fraction = key(SPLIT, "part of the rest that is trained on; the last part is tested on")
    horizon: Positive = key(HORIZON, "longest delay; also the blocks of the bootstrap", "s")
    alpha: Positive | Literal["cv"] = key(
        ALPHA, "ridge penalty; cv chooses it by blocked cross-validation on the training part"
    )
    taps: Annotated[int, Field(ge=1)] | None = key(
        None, "of the delay line, in frames; null takes as many as the recording remembers"
    )
    order: list[Literal[ORDERS]] = key([*ORDERS], "orders of the NARMA tasks")
    amplitude: Positive = key(0.2, "of the NARMA tasks' input, from 0")
    bar: Positive | None = key(None, "NMSE below which a NARMA task counts as passed")

    def settled(self) -> CardOptions:
        """The options with what the recipe says of those that were not given."""
        recipe = RECIPES.get(self.recipe, {})
        given = self.model_fields_set
        return self.model_copy(update={k: v for k, v in recipe.items() if k not in given})
