"""Forces that a model lacks, recovered along a trajectory: by laws, curves and smooth forces."""
