"""Many drives: a specification, a folder, a table (docs/campaign.md)."""

from .run import Campaign, Progress, campaign
from .spec import Spec

__all__ = ["Campaign", "Progress", "Spec", "campaign"]
