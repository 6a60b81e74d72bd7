// name: message-types
// kind: table
// description: Which message types do channels have, as they were observed or stated, and what do they carry?
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns robot: string, name of the robot
// returns channel: string, name of the channel
// returns leg: string, of a service or action: request or response
// returns types: list of string, names of the types
// returns carries: list of string, kinds of data that get there, broader ones too
// order: robot, channel, leg
MATCH (c:Topic|Service|Action)
WHERE c.types IS NOT NULL AND ($robot = '' OR c.robot = $robot)
RETURN DISTINCT c.robot AS robot, c.name AS channel, coalesce(c.leg, '') AS leg, c.types AS types, c.carries AS carries
ORDER BY robot, channel, leg
