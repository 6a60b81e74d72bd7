// name: beyond-profiles
// kind: table
// description: What could get to a leak only if a node went beyond its own profile, and what would take that away?
// param robot: robot, only what begins or ends at this robot; all robots if it is empty, default ""
// returns robot: string, name of the robot of the source
// returns asked: boolean, whether it was loaded with --view both; if not, this is not known, and the row says no more
// returns kind: string, kind of finding, such as disclosure
// returns category: string, the kind of data that would arrive
// returns source: string, where the data comes in
// returns leak: string, where it would get out
// returns beyond: list of string, steps that no profile of their node allows, with the policy line of another one
// returns enclaves: list of string, whose nodes share their rights on the way
// returns split: list of string, enclaves of which splitting takes it away; empty if none was found
// returns move: string, the profile of which an enclave of its own takes it away alone; empty if none was found
// returns deny: list of string, DENY lines that take it away; each holds for its whole enclave
// returns loses: list of string, what nodes would lose by these lines that their own profiles allow
// returns leak_robot: string, name of the robot of the leak, which may be another one
// order: robot, category, source, leak, leak_robot, kind
MATCH (r:Robot)
OPTIONAL MATCH (f:AddedFinding {robot: r.name})
WITH r, f WHERE (f IS NOT NULL OR r.beyond IS NULL AND r.shared IS NULL)
            AND ($robot = '' OR r.name = $robot OR f.leak_robot = $robot)
RETURN r.name AS robot, r.beyond IS NOT NULL AS asked, f.kind AS kind, f.category AS category, f.source AS source,
       f.leak AS leak, f.beyond AS beyond, f.enclaves AS enclaves, f.split AS split, f.move AS move, f.deny AS deny,
       f.loses AS loses, f.leak_robot AS leak_robot
ORDER BY robot, category, source, leak, leak_robot, kind
