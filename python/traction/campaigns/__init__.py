"""Many drives: a specification, a folder, a table (docs/campaign.md)."""

from .run import Campaign, Progress, campaign, plot_campaign
from .sensitivity import Effects, Index, Sensitivity
from .spec import Spec

__all__ = ["Campaign", "Effects", "Index", "Progress", "Sensitivity", "Spec", "campaign", "plot_campaign"]
