"""What every figure of a report is made with: plotly JSON, colours, time axes, rows of the log."""
