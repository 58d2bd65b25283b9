"""Which of several animations people find most natural: the study's pages, answers, analysis."""
