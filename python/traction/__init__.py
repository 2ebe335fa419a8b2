"""Ground speed, slip and traction of a small wheeled rover: its simulator, its firmware, and the lab that names what a model lacks.

    import traction
    log = traction.simulate("identification", effects=["slip_sinkage:coefficient=0.2"], seed=7)
    told = traction.diagnose("rover_sand", log)
    better = traction.add("rover_sand", "slip_sinkage", log)

Numbers are the command line's own. Every unit is SI and stands in the name.
"""

from importlib.metadata import version as _version

from ._errors import CampaignError, FileError, InputError, LogError, ModelError, Refused, ScenarioError
from .campaigns import Campaign, Spec, campaign, plot_campaign
from .lab import (
    Addition,
    Balance,
    Candidate,
    Check,
    Comparison,
    Diagnosis,
    Finding,
    Fit,
    FittedValue,
    LadderStep,
    Model,
    Proposal,
    Result,
    Verdict,
    add,
    check,
    compare,
    diagnose,
    drop,
    fit,
    next,
)
from .log import Column, Log, Run
from .loop import Command, Firmware, Frame, Mode, Plant, Trace
from .scenario import Effect, EffectParameter, Rover, RoverParameter, effects, simulate

__version__ = _version("traction")

__all__ = [
   "Addition", "Balance", "Campaign", "CampaignError", "Candidate", "Check", "Column", "Command", "Comparison", "Diagnosis", "Effect",
   "EffectParameter", "FileError", "Finding", "Firmware", "Fit", "FittedValue", "Frame", "InputError", "LadderStep", "Log", "LogError",
   "Mode", "Model", "ModelError", "Plant", "Proposal", "Refused", "Result", "Rover", "RoverParameter", "Run", "ScenarioError", "Spec",
   "Trace", "Verdict", "add", "campaign", "check", "compare", "diagnose", "drop", "effects", "fit", "next", "plot_campaign", "simulate",
]  # fmt: skip
