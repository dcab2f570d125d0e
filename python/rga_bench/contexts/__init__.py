"""The paper's table: levels of integration, with every rival beside the networks."""
