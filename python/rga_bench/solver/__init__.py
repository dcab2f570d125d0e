"""What a simulated sample costs: rga beside other solvers, on the same structures."""
