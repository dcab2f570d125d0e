"""What is to be known of the channels that a source sends."""

from dataclasses import dataclass, field

#: channels of which something is told, and sets of columns that are remembered
MOST_KNOWN = 1000


@dataclass(frozen=True)
class ChannelRemarks:
    """Channels of a source that are not used, or not used as they say.

    Attributes:
        refused: by channel, why what is sent of it is not used.
        doubted: by channel, what is doubtful of it though it is used.

    >>> remarks = ChannelRemarks()
    >>> remarks.refuse("D7", "the model has no such channel")
    >>> remarks.refused
    {'D7': 'the model has no such channel'}
    """

    refused: dict[str, str] = field(default_factory=dict)
    doubted: dict[str, str] = field(default_factory=dict)

    def refuse(self, channel: str, why: str) -> None:
        """Tell that what is sent of a channel is not used, unless that is told of very many."""
        if len(self.refused) < MOST_KNOWN:
            self.refused[channel] = why

    def doubt(self, channel: str, why: str) -> None:
        """Tell what is doubtful of a channel, unless that is told of very many."""
        if len(self.doubted) < MOST_KNOWN:
            self.doubted[channel] = why
