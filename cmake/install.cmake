# Install and export targets.
