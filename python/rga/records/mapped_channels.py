"""Whether a mapping speaks of channels of a model, in units that they can have."""

from rga.errors import InputError, SeveralMistakes
from rga.model import Model
from rga.records.mapping import FileMapping
from rga.records.units import conversion


def check_channels(mapping: FileMapping, model: Model, where: str) -> None:
    """Refuse a mapping whose channels or units cannot be those of a model.

    Args:
        mapping: of a logger.
        model: names the sensors and contexts and states their units.
        where: the mapping, or the file that it is of, for an error.

    Raises:
        InputError: it names a channel that the model does not have, or states a unit that is none
            of what is measured; where it does so more than once, with all of them
            (`SeveralMistakes`).
    """
    faults = []
    for name, channel in mapping.channels.items():
        if name not in model.sensors and name not in model.context:
            what = f"the mapping names the channel {name!r}, which the model does not have"
            remedy = "name a sensor or context variable of the model"
            faults.append(InputError(what, where, remedy))
        elif channel.unit is not None:
            try:
                conversion(channel.unit, name, model, where)
            except InputError as error:
                faults.append(error)
    if len(faults) > 1:
        told = [one.what for one in faults]
        raise SeveralMistakes(told, where, "correct them under [channels] in import.toml")
    if faults:
        raise faults[0]
