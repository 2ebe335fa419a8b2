"""Many drives: a specification, a folder, a table (docs/campaign.md)."""

from .lab_bench import LabSpec, LabTable, plan_of, read_plan
from .run import Campaign, Progress, campaign, plot_campaign
from .sensitivity import Effects, Index, Sensitivity
from .spec import Spec

__all__ = [
   "Campaign", "Effects", "Index", "LabSpec", "LabTable", "Progress", "Sensitivity", "Spec", "campaign", "plan_of", "plot_campaign",
   "read_plan",
]  # fmt: skip
