"""What recordings say of motion: inputs of the filters, steps and headings of poses."""
