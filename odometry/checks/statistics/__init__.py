"""Relations, lags and outliers of measured columns, whatever they measure."""
