"""What the floor does to the puck: slow, trusted, independent of the compiled code."""

from typing import TYPE_CHECKING

from puck_tables._core.lazy import lazily

if TYPE_CHECKING:
    from puck_tables.contact.closed_form import Resultants, is_full_contact
    from puck_tables.contact.one_sided import critical_delta, loaded_share
    from puck_tables.contact.one_sided import resultants as one_sided_resultants
    from puck_tables.contact.speed_quadrature import speed_resultants

__all__ = [
    "Resultants", "critical_delta", "is_full_contact", "loaded_share", "one_sided_resultants",
    "speed_resultants",
]  # fmt: skip

__getattr__, __dir__ = lazily(__name__)
